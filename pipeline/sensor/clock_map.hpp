#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "pipeline/core/time.hpp"

namespace kinectlab {

/// Maps a device's clock to UTC. A frame arrives late by transfer and scheduling, never early, so
/// the smallest difference between arrival and device time is the best guess of the clocks' offset.
/// In the first second the offset is taken as that minimum; from then on it follows the minimum of
/// each five seconds, slowly (time constant 120 s): a late frame moves nothing, and the rate stays
/// the device's own to a few ppm, which is what a period is measured with. A constant drift of the
/// device of d leaves a constant error of 120 s · d (6 ms at 50 ppm).
/// While it is held the offset stays as it is, once the first second is over: a motion is then
/// measured with the device's own rate alone, whatever the computer was late by before.
/// A wall clock that is set forward by more than a second is followed at once, one that is set
/// back is not until the device is opened again: times never run backwards.
class ClockMap {
public:
    /// Later times will be after `floor`, whatever the new device clock says.
    explicit ClockMap(TimeNs floor = 0) : last_(floor) {}

    void hold(bool held) { held_ = held; }

    /// `device_us` of successive frames increases; `arrival` is UTC at reading. Strictly
    /// increasing.
    [[nodiscard]] TimeNs map(std::uint64_t device_us, TimeNs arrival);

    /// The time of something else on the same device clock, e.g. a colour picture; changes nothing.
    [[nodiscard]] TimeNs peek(std::uint64_t device_us) const;

    /// False until the first frame: there is no offset yet.
    [[nodiscard]] bool is_set() const { return start_.has_value(); }

private:
    std::optional<TimeNs> start_;  ///< device time of the first frame, ns
    TimeNs block_start_ = 0;
    TimeNs block_minimum_ = std::numeric_limits<TimeNs>::max();
    TimeNs target_ = 0;
    double offset_ = 0.0;  ///< ns; target_ of warm-up plus what was followed since
    TimeNs base_ = 0;      ///< offset_ counts from here, so that a double keeps its nanoseconds
    TimeNs previous_device_ = 0;
    TimeNs last_;
    bool held_ = false;
};

}  // namespace kinectlab
