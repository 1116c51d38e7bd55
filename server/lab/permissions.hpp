#pragma once

#include "pipeline/core/error.hpp"
#include "server/lab/booking.hpp"
#include "server/lab/people.hpp"
#include "server/lab/run.hpp"

namespace kinectlab::lab {

/// Only the slot's owner starts a run, inside the slot, and only if the measurement can still end
/// in it. Errors: forbidden, conflict (with when it would be possible).
[[nodiscard]] Result<void> may_start_run(
    const User& user, const Booking& booking, double duration_s, TimeNs now
);

/// Release, stop, abort: the owner, assistants and up.
[[nodiscard]] Result<void> may_command_run(const User& user, const Run& run);

/// The run, its poses and its result: the owner, assistants and up.
[[nodiscard]] Result<void> may_see_run(const User& user, const Run& run);

/// The owner and staff, before the booking's end.
[[nodiscard]] Result<void> may_cancel_booking(const User& user, const Booking& booking, TimeNs now);

/// Whose booking it is: its owner, assistants and up.
[[nodiscard]] bool may_see_name(const User& user, const Booking& booking);

}  // namespace kinectlab::lab
