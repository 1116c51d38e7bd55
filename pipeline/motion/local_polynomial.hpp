#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "pipeline/core/time.hpp"

namespace kinectlab {

/// A value at a time with the weights that its covariance asks for.
struct TimedVector {
    TimeNs t = 0;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    Eigen::Vector3d variance = Eigen::Vector3d::Ones();  ///< of each component
};

struct Derivatives {
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Vector3d second = Eigen::Vector3d::Zero();  ///< NaN where too few samples show it
    Eigen::Vector3d first_variance = Eigen::Vector3d::Zero();
    Eigen::Vector3d second_variance = Eigen::Vector3d::Zero();  ///< NaN as `second`
};

/// Half of the window in seconds whose local cubic passes velocities up to `bandwidth_hz` (-3 dB).
[[nodiscard]] double half_window_s(double bandwidth_hz);

/// First and second derivative at time t by weighted local polynomial regression (Savitzky & Golay
/// 1964 for uneven times; Cleveland 1979): a cubic through the samples within half_window_s,
/// weighted by 1/variance and by 1 - (Δt/half_window)² (Epanechnikov). With fewer than five samples
/// the degree falls so that one is left over; nothing with fewer than three. `samples` in strictly
/// increasing time.
[[nodiscard]] std::optional<Derivatives> differentiate(
    std::span<const TimedVector> samples, TimeNs t, double half_window_s
);

}  // namespace kinectlab
