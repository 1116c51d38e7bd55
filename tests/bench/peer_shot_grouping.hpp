#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab::bench {

/// PCL's correspondence grouping as in its tutorial: uniform keypoints, SHOT descriptors, matches
/// with a squared distance below 0.25, Hough 3-D grouping in local reference frames (BOARD); of the
/// instances the one with most matches. Sizes in proportion to the tutorial's for its carton.
/// Nothing where no instance was found.
[[nodiscard]] std::optional<Eigen::Isometry3d> find_by_shot(
    const RgbdCamera& camera,
    const RgbdFrame& frame,
    const std::vector<Eigen::Vector3f>& model_points,
    double radius_m
);

}  // namespace kinectlab::bench
