#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/track/patch_table.hpp"

namespace kinectlab {

/// A pose that one of a model's views suggests.
struct ViewPose {
    Eigen::Isometry3f T_cam_obj;  ///< of the model's centre
    std::uint32_t view;
};

/// Poses in which a model may be what has moved, as rough as the table's views are: each view is
/// turned about the line of sight in steps of 22.5°, and the middle of what it shows laid upon the
/// middle of the readings, row-major `pixels` of `depth` (counts; 0 = none). A flat face shown
/// squarely has no patch to be recognised by, but it has a middle. Nothing of fewer than 40
/// readings.
[[nodiscard]] std::vector<ViewPose> moved_poses(
    std::span<const std::uint16_t> depth,
    const RgbdCamera& camera,
    std::span<const std::uint32_t> pixels,
    const PatchTable& table
);

}  // namespace kinectlab
