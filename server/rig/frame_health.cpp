#include "server/rig/frame_health.hpp"

#include <algorithm>

namespace kinectlab::rig {
namespace {

constexpr TimeNs kWindow = 3 * kNsPerSecond;

}  // namespace

std::uint32_t FrameHealth::on_frame(std::uint64_t index, TimeNs t) {
    const bool gap = any_ && index > last_index_ + 1;
    const auto missing = gap ? static_cast<std::uint32_t>(index - last_index_ - 1) : 0U;
    any_ = true;
    last_index_ = index;
    lost_ += missing;
    times_.push_back(t);
    while (times_.front() <= t - kWindow)
        times_.pop_front();
    return missing;
}

double FrameHealth::rate_hz(TimeNs now) const {
    const auto first =
        std::find_if(times_.begin(), times_.end(), [&](TimeNs t) { return t > now - kWindow; });
    const auto count = std::distance(first, times_.end());
    // A camera that has just stopped must not keep its rate: the silence counts too.
    if (count < 2) return 0.0;
    const TimeNs silent = std::max<TimeNs>(now - times_.back() - kNsPerSecond / 5, 0);
    return static_cast<double>(count - 1) / to_seconds(times_.back() - *first + silent);
}

}  // namespace kinectlab::rig
