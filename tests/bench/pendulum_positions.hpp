#pragma once

#include <cstdint>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

namespace kinectlab::bench {

/// A swing and what a camera's positions of it are off by.
struct PositionRun {
    testing::Swing swing;
    Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< of the noise, lab frame, m
    Eigen::Vector3d told = Eigen::Vector3d::Zero();   ///< what the tracker says of it, m
    double kept = 0.0;  ///< share of one frame's noise that is there in the next
};

/// 30 s on a metre. White: the size and the tracker's claim as on rendered frames with a Kinect's
/// noise, 0.42 mm to each side and no correlation in time (five runs, lags up to four seconds below
/// 0.03). Correlated: harder than any rendered run; five times as much along the view, and half of
/// the noise lasts into the next frame.
[[nodiscard]] PositionRun position_run(bool correlated);

[[nodiscard]] Trajectory with_noise(
    Trajectory trajectory, const PositionRun& run, std::uint64_t seed
);

/// What the generator's swing is in the fit's own terms.
[[nodiscard]] SwingParameters true_parameters(const PositionRun& run);

/// Cramér and Rao's bound on the standard deviation of g for these positions with the noise's
/// covariance known, the length exact, all else that the pendulum's fit leaves free free too, m/s².
[[nodiscard]] double least_scatter_of_g(const PositionRun& run);

}  // namespace kinectlab::bench
