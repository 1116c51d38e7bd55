#pragma once

#include <cstdint>

namespace kinectlab {

/// Nanoseconds since the Unix epoch, UTC, taken at capture.
using TimeNs = std::int64_t;

constexpr TimeNs kNsPerSecond = 1'000'000'000;

constexpr double to_seconds(TimeNs duration) {
    return static_cast<double>(duration) * 1e-9;
}

constexpr TimeNs from_seconds(double seconds) {
    return static_cast<TimeNs>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5));
}

}  // namespace kinectlab
