#include "pipeline/sensor/clock_map.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr TimeNs kWarmUp = kNsPerSecond;
constexpr TimeNs kBlock = 5 * kNsPerSecond;
constexpr TimeNs kClockWasSet = kNsPerSecond;
constexpr double kTimeConstantNs = 120e9;

}  // namespace

TimeNs ClockMap::map(std::uint64_t device_us, TimeNs arrival) {
    const TimeNs device = static_cast<TimeNs>(device_us) * 1000;
    const TimeNs difference = arrival - device;
    if (!start_) {
        start_ = block_start_ = previous_device_ = device;
        base_ = target_ = difference;
    }
    block_minimum_ = std::min(block_minimum_, difference);
    if (device - *start_ < kWarmUp) {
        target_ = std::min(target_, difference);
        offset_ = static_cast<double>(target_ - base_);
    } else if (!held_) {
        const double step = static_cast<double>(device - previous_device_) / kTimeConstantNs;
        offset_ += std::clamp(step, 0.0, 1.0) * (static_cast<double>(target_ - base_) - offset_);
    }
    previous_device_ = device;
    if (device - block_start_ >= kBlock) {
        const TimeNs jump = block_minimum_ - target_;
        if (jump > -kClockWasSet) target_ = block_minimum_;
        if (jump > kClockWasSet && !held_) offset_ = static_cast<double>(target_ - base_);
        block_start_ = device;
        block_minimum_ = std::numeric_limits<TimeNs>::max();
    }
    last_ = std::max(last_ + 1000, peek(device_us));
    return last_;
}

TimeNs ClockMap::peek(std::uint64_t device_us) const {
    return static_cast<TimeNs>(device_us) * 1000 + base_ + std::llround(offset_);
}

}  // namespace kinectlab
