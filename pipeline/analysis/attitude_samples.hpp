#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/error.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab {

/// One measured attitude; whiten makes the noise of its rotation vector one in every direction.
struct AttitudeSample {
    std::size_t index = 0;  ///< in the trajectory
    double t = 0.0;         ///< s since the trajectory's first sample
    Eigen::Quaterniond q_lab_obj;
    Eigen::Matrix3d whiten;  ///< of a rotation vector in the lab frame, 1/rad
};

/// The rotation vector (lab frame, rad, at most π) that turns `from` into `to`.
[[nodiscard]] Eigen::Vector3d turn_between(
    const Eigen::Quaterniond& from, const Eigen::Quaterniond& to
);

/// Of the four attitudes that a box without marks cannot be told apart in (itself and half a turn
/// about each of its axes), the one nearest to `expected`.
[[nodiscard]] Eigen::Quaterniond nearest_alike(
    const Eigen::Quaterniond& q, const Eigen::Quaterniond& expected
);

/// The tracked samples with an orientation. One without a usable covariance counts as known to
/// 10 mrad. With `alike`, each is the one of its four likes that continues the turning before it.
/// Errors (bad_data): times that do not increase, a tracked orientation that is no number, fewer
/// than `fewest` of them.
[[nodiscard]] Result<std::vector<AttitudeSample>> collect_attitudes(
    const Trajectory& trajectory, bool alike, std::size_t fewest = 12
);

}  // namespace kinectlab
