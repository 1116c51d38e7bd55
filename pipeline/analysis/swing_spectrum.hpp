#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "pipeline/analysis/position_samples.hpp"

namespace kinectlab {

/// x and y over time, one row for each sample.
using PlanePath = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// The two horizontal axes' weights in a guess: the noisier one counts less; the larger is 1.
[[nodiscard]] Eigen::Vector2d axis_weights(std::span<const PositionSample> samples);

/// The frequency of the horizontal motion, 1/s: the highest peak of the least-squares spectrum
/// (Lomb, Astrophys. Space Sci. 39 (1976)) times the frequency squared, that is, of the velocities:
/// standing still does not count, sampling may be uneven and have gaps. Of a long record the minute
/// that moves most is looked at, and its halves and quarters if no peak stands out of the noise in
/// all of it. Nothing if none does there either.
[[nodiscard]] std::optional<double> find_frequency(
    std::span<const PositionSample> samples, double length_m
);

}  // namespace kinectlab
