#pragma once

#include <cstdint>
#include <deque>

#include "pipeline/core/time.hpp"

namespace kinectlab::rig {

/// Counts what a camera delivers and what is missing, from the frames' own counter and times.
class FrameHealth {
public:
    /// Returns how many frames are missing just before this one. A counter that goes back belongs
    /// to a device that was opened again: nothing is counted as missing then.
    std::uint32_t on_frame(std::uint64_t index, TimeNs t);

    /// Over the frames of the three seconds before `now`; 0 if there are none.
    [[nodiscard]] double rate_hz(TimeNs now) const;
    [[nodiscard]] std::int64_t lost() const { return lost_; }

private:
    std::deque<TimeNs> times_;
    std::uint64_t last_index_ = 0;
    bool any_ = false;
    std::int64_t lost_ = 0;
};

}  // namespace kinectlab::rig
