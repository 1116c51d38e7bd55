#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/track_sample.hpp"

namespace kinectlab {

/// The same spot of an object in its own frame and as seen now.
struct PointPair {
    Eigen::Vector3d p_obj = Eigen::Vector3d::Zero();           ///< m
    Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();           ///< m
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of p_cam - T·p_obj, m²
};

/// A rigid transform and how well the pairs agree on it.
struct RigidFit {
    Eigen::Isometry3d T_cam_obj = Eigen::Isometry3d::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< position (m²), then rotation vector (rad²)
    int inliers = 0;
    double rms_sigmas = 0.0;  ///< of the inliers' residuals, 1 where their covariances are true
    std::vector<std::uint32_t> inlier_pairs;  ///< indices, ascending
};

struct RigidFitSettings {
    int fewest_inliers = 6;     ///< three points fit anything; six that agree do not by chance
    double fewest_share = 0.0;  ///< of the pairs
    double gate_sigmas = 4.0;   ///< 99.9 % of true pairs lie within (chi-square, 3 unknowns)
    int most_draws = 2000;      ///< where hardly any pair is right
    double most_turn_u = 0.2;   ///< rad; a fit less sure (points on a line) is none
};

/// RANSAC over three pairs (Fischler & Bolles 1981; closed form of Umeyama 1991), until the chance
/// of never having drawn three right ones is 10⁻³; then Gauss-Newton over the inliers, weighted by
/// their covariances, with Tukey's weights. Deterministic. Nothing where too few pairs agree, where
/// they leave a rotation open, or where a number is not finite.
[[nodiscard]] std::optional<RigidFit> fit_rigid(
    std::span<const PointPair> pairs, const RigidFitSettings& settings
);

}  // namespace kinectlab
