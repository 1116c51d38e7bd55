#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "sift3d" (the paper's III.C.2 and equation 5): spots of a surface's brightness over space
/// and scale, on voxels, described by 2,048 numbers in a frame of their own, matched to those of
/// the object as it looked at first; the pose is the rigid transform of most of them. It does not
/// care from where the camera looks, which a picture's spots do; it needs larger spots, and costs
/// more.
///
/// The first look, and what is lost: as with method "texture".
[[nodiscard]] std::unique_ptr<Tracker> make_sift3d_tracker(
    const RgbdCamera& camera, TrackedObjects<Sift3dTrackSettings> objects
);

/// Refuses a box outside of the picture, scale_m not 0.001 to 0.1, fewest_spots not 4 to 1000.
[[nodiscard]] Result<void> check(
    const Sift3dTrackSettings& settings, const RgbdCamera& camera, const std::string& path
);

}  // namespace kinectlab
