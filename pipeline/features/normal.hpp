#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"

namespace kinectlab {

/// A point on a surface, camera frame.
struct OrientedPoint {
    Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();   ///< m
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, towards the camera
    double disparity = 0.0;                            ///< steps, as read
};

/// Point and normal at a pixel from the plane through its neighbours within half_window pixels.
/// A plane n·p = d is linear in the picture, 1/Z = (n/d)·ray(u, v), so the fit is linear least
/// squares in disparity, where the noise is the same everywhere. Neighbours without a reading or
/// more than max_jump_steps away belong to something else; nothing is returned if fewer than half
/// of the window remain, or where the pixel itself has no reading.
[[nodiscard]] std::optional<OrientedPoint> oriented_point(
    std::span<const std::uint16_t> depth,
    const Pinhole& camera,
    const DisparityScale& scale,
    std::uint32_t pixel,
    int half_window,
    double max_jump_steps
);

}  // namespace kinectlab
