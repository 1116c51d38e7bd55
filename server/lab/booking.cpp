#include "server/lab/booking.hpp"

#include <algorithm>
#include <cstdlib>

#include "server/lab/utc.hpp"

namespace kinectlab::lab {
namespace {

constexpr TimeNs round_down(TimeNs t, TimeNs step) {
    const TimeNs rest = t % step;
    return t - (rest < 0 ? rest + step : rest);
}

constexpr TimeNs round_up(TimeNs t, TimeNs step) {
    return round_down(t + step - 1, step);
}

/// To the minute, where a rounded span could read like the limit that it breaks.
std::string minutes(TimeNs span) {
    return std::to_string(span / (60 * kNsPerSecond));
}

struct Range {
    TimeNs from = 0;
    TimeNs to = 0;
};

/// When slots may lie, on whole blocks: the block that has begun counts.
Range bookable(TimeNs now, const BookingRules& rules) {
    return {round_down(now, rules.granularity), round_down(now + rules.horizon, rules.granularity)};
}

Result<void> check_times(const Slot& slot, TimeNs now, const BookingRules& rules) {
    const auto check_grid = [&](const char* field, TimeNs t) -> Result<void> {
        if (t % rules.granularity == 0) return {};
        return fail(
            ErrorCode::invalid_argument,
            field,
            "is " + to_rfc3339(t),
            "give a time on whole " + span_text(rules.granularity)
        );
    };
    if (auto start = check_grid("start", slot.start); !start) return start;
    if (auto end = check_grid("end", slot.end); !end) return end;

    const Range range = bookable(now, rules);
    if (slot.start < range.from) {
        return fail(
            ErrorCode::invalid_argument,
            "start",
            "is " + to_rfc3339(slot.start) + ", in the past",
            "give " + to_rfc3339(range.from) + " or later"
        );
    }
    // Compared before subtracting: times come from strangers and may be far apart.
    if (slot.end <= slot.start || slot.end > range.to) {
        return fail(
            ErrorCode::invalid_argument,
            "end",
            "is " + to_rfc3339(slot.end),
            slot.end <= slot.start ? "give a time after the start"
                                   : "give " + to_rfc3339(range.to) + " or earlier"
        );
    }
    const TimeNs length = slot.end - slot.start;
    if (length < rules.shortest || length > rules.longest) {
        return fail(
            ErrorCode::invalid_argument,
            "end",
            "makes the slot " + minutes(length) + " min long",
            "give a slot of " + minutes(rules.shortest) + " to " + minutes(rules.longest) + " min"
        );
    }
    return {};
}

/// Up to `count` slots that do not touch one another inside a free range, from the one nearest to
/// the wish outwards.
void add_from_gap(
    std::vector<Slot>& found,
    const Slot& wanted,
    const std::string& rig,
    Range gap,
    std::size_t count
) {
    const TimeNs length = wanted.end - wanted.start;
    if (gap.to - gap.from < length) return;
    const TimeNs nearest = std::clamp(wanted.start, gap.from, gap.to - length);
    const auto offered = static_cast<TimeNs>(count);
    for (TimeNs k = -offered; k <= offered; ++k) {
        const TimeNs start = nearest + k * length;
        if (start >= gap.from && start + length <= gap.to) {
            found.push_back({rig, start, start + length});
        }
    }
}

/// The free ranges of a rig, on whole blocks.
std::vector<Range> gaps(
    const std::string& rig, std::span<const Booking> existing, Range range, TimeNs granularity
) {
    std::vector<Range> taken;
    for (const auto& booking : existing) {
        const Slot& slot = booking.slot;
        if (slot.rig == rig && slot.start < range.to && range.from < slot.end) {
            taken.push_back({slot.start, slot.end});
        }
    }
    std::sort(taken.begin(), taken.end(), [](Range a, Range b) { return a.from < b.from; });
    std::vector<Range> free;
    TimeNs from = range.from;
    for (const Range& slot : taken) {
        if (slot.from > from) free.push_back({from, round_down(slot.from, granularity)});
        from = std::max(from, round_up(slot.to, granularity));
    }
    if (from < range.to) free.push_back({from, range.to});
    return free;
}

}  // namespace

Result<void> check_booking(
    const BookingRequest& request,
    std::span<const Booking> existing,
    TimeNs now,
    const BookingRules& rules
) {
    if (auto times = check_times(request.slot, now, rules); !times) return times;

    const auto taken = std::find_if(existing.begin(), existing.end(), [&](const Booking& booking) {
        return overlap(booking.slot, request.slot);
    });
    if (taken != existing.end()) {
        return fail(
            ErrorCode::conflict,
            "start",
            "the rig is taken from " + to_rfc3339(taken->slot.start) + " to " +
                to_rfc3339(taken->slot.end),
            "choose another time or another rig"
        );
    }

    const auto held = std::count_if(existing.begin(), existing.end(), [&](const Booking& booking) {
        return booking.user == request.user && booking.slot.end > now;
    });
    if (request.role == Role::student && held >= rules.held_by_student) {
        return fail(
            ErrorCode::conflict,
            "user",
            "holds " + std::to_string(held) + " bookings, the most a student may",
            "use or cancel one first"
        );
    }
    return {};
}

std::vector<Slot> alternatives(
    const Slot& wanted,
    std::span<const std::string> rigs,
    std::span<const Booking> existing,
    TimeNs now,
    std::size_t count,
    const BookingRules& rules
) {
    if (wanted.end <= wanted.start) return {};
    const TimeNs length = wanted.end - wanted.start;
    if (length < rules.shortest || length > rules.longest || length % rules.granularity != 0) {
        return {};
    }
    const Slot aligned{
        wanted.rig,
        round_down(wanted.start, rules.granularity),
        round_down(wanted.start, rules.granularity) + length};

    std::vector<Slot> found;
    for (const auto& rig : rigs) {
        for (const Range& gap : gaps(rig, existing, bookable(now, rules), rules.granularity)) {
            add_from_gap(found, aligned, rig, gap, count);
        }
    }
    // The wanted rig first where the times are equally near.
    const auto rank = [&](const Slot& slot) {
        return std::tuple(
            std::abs(slot.start - aligned.start), slot.rig != wanted.rig, slot.start, slot.rig
        );
    };
    std::sort(found.begin(), found.end(), [&](const Slot& a, const Slot& b) {
        return rank(a) < rank(b);
    });
    if (found.size() > count) found.resize(count);
    return found;
}

}  // namespace kinectlab::lab
