#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "tests/bench/oriented_points.hpp"

namespace kinectlab::bench {

/// PCL's correspondence grouping as in its tutorial: uniform keypoints, SHOT descriptors, their
/// nearest matches, Hough 3-D grouping in local reference frames (BOARD); of the
/// instances the one with most matches. T_cam_obj; nothing where no instance was found.
[[nodiscard]] std::optional<Eigen::Isometry3d> find_by_shot(
    const OrientedPoints& model, const OrientedPoints& scene
);

}  // namespace kinectlab::bench
