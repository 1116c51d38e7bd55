#pragma once

#include <vector>

#include <Eigen/Core>

#include "pipeline/core/error.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab {

/// One measured position; whiten makes its noise one in every direction.
struct PositionSample {
    std::size_t index = 0;   ///< in the trajectory
    double t = 0.0;          ///< s since the trajectory's first sample
    Eigen::Vector3d p_lab;   ///< m
    Eigen::Matrix3d whiten;  ///< whiten · covariance · whitenᵀ = 1, 1/m
    Eigen::Vector3d sigma;   ///< of the three axes, m
};

/// The tracked samples. One without a usable covariance counts as known to a millimetre.
/// Errors (bad_data): times that do not increase, a tracked position or its covariance not finite,
/// fewer than `fewest` tracked samples.
[[nodiscard]] Result<std::vector<PositionSample>> collect_position_samples(
    const Trajectory& trajectory, std::size_t fewest = 30
);

}  // namespace kinectlab
