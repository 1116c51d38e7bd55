#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "server/lab/people.hpp"

namespace kinectlab::lab {

using BookingId = std::int64_t;

/// Half-open: a slot that ends at 10:00 leaves 10:00 free.
struct Slot {
    std::string rig;
    TimeNs start = 0;
    TimeNs end = 0;

    bool operator==(const Slot&) const = default;
};

struct Booking {
    BookingId id = 0;
    UserId user = 0;
    std::string user_name;   ///< the display name of `user`, filled in when read back
    std::string experiment;  ///< id of its definition
    Slot slot;
    TimeNs created = 0;
};

struct BookingRequest {
    UserId user = 0;
    Role role = Role::student;
    std::string experiment;
    Slot slot;
};

/// What every booking keeps to.
struct BookingRules {
    TimeNs granularity = 300 * kNsPerSecond;     ///< slots start and end on whole multiples of it
    TimeNs shortest = 300 * kNsPerSecond;        ///< end minus start
    TimeNs longest = 7200 * kNsPerSecond;        ///< end minus start
    TimeNs horizon = 30 * 86400 * kNsPerSecond;  ///< no slot ends later than now plus this
    int held_by_student = 5;  ///< bookings that are not over; assistants and up have no limit
};

[[nodiscard]] constexpr bool overlap(const Slot& a, const Slot& b) {
    return a.rig == b.rig && a.start < b.end && b.start < a.end;
}

/// Whether the request may become a booking beside `existing` (at least all bookings of its rig
/// from now on and all of its user; more do no harm). A slot may have begun as long as its first
/// block of five minutes lasts, so that a free rig can be used at once.
/// Errors: invalid_argument names `start` or `end`; conflict names `start` where the rig is taken
/// and `user` where the student holds enough bookings.
[[nodiscard]] Result<void> check_booking(
    const BookingRequest& request,
    std::span<const Booking> existing,
    TimeNs now,
    const BookingRules& rules = {}
);

/// Slots as long as the requested one that are free, nearest in start first, on any of `rigs`; each
/// of them would pass check_booking's rules on time and overlap. Empty if the length itself is
/// wrong.
[[nodiscard]] std::vector<Slot> alternatives(
    const Slot& wanted,
    std::span<const std::string> rigs,
    std::span<const Booking> existing,
    TimeNs now,
    std::size_t count = 3,
    const BookingRules& rules = {}
);

}  // namespace kinectlab::lab
