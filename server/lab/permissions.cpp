#include "server/lab/permissions.hpp"

#include "server/lab/utc.hpp"

namespace kinectlab::lab {
namespace {

/// What a rig needs to bring its bob to rest and up to its angle.
constexpr TimeNs kPreparation = 30 * kNsPerSecond;

Result<void> owner_or(Role needed, const User& user, UserId owner, const std::string& whose) {
    if (user.id == owner || at_least(user.role, needed)) return {};
    return fail(
        ErrorCode::forbidden,
        "",
        whose + " belongs to somebody else",
        "ask its owner, or somebody with the role " + std::string(to_text(needed))
    );
}

}  // namespace

Result<void> may_start_run(
    const User& user, const Booking& booking, double duration_s, TimeNs now
) {
    if (booking.user != user.id) {
        return fail(
            ErrorCode::forbidden, "rig", "is booked by somebody else now", "book a slot of your own"
        );
    }
    const Slot& slot = booking.slot;
    if (now < slot.start || now >= slot.end) {
        return fail(
            ErrorCode::conflict,
            "rig",
            "is yours from " + to_rfc3339(slot.start) + " to " + to_rfc3339(slot.end),
            now < slot.start ? "start the run then" : "book another slot"
        );
    }
    if (now + kPreparation + from_seconds(duration_s) > slot.end) {
        return fail(
            ErrorCode::conflict,
            "duration_s",
            "the slot ends in " + span_text(slot.end - now) + ", too soon to prepare and measure " +
                span_text(from_seconds(duration_s)),
            "choose a shorter duration or book another slot"
        );
    }
    return {};
}

Result<void> may_command_run(const User& user, const Run& run) {
    return owner_or(Role::assistant, user, run.user, "the run");
}

Result<void> may_see_run(const User& user, const Run& run) {
    return owner_or(Role::assistant, user, run.user, "the run");
}

Result<void> may_cancel_booking(const User& user, const Booking& booking, TimeNs now) {
    if (auto owner = owner_or(Role::staff, user, booking.user, "the booking"); !owner) return owner;
    if (now < booking.slot.end) return {};
    return fail(
        ErrorCode::conflict, "end", "was at " + to_rfc3339(booking.slot.end) + ": it is over"
    );
}

bool may_see_name(const User& user, const Booking& booking) {
    return user.id == booking.user || at_least(user.role, Role::assistant);
}

}  // namespace kinectlab::lab
