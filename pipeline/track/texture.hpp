#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "texture" (the paper's III.C.2): spots of the colour picture, found by SIFT or by a fast
/// binary description, traced back to the surface through the geometry of both cameras, matched to
/// those of the object as it looked at first; the pose is the rigid transform of most of them. Six
/// degrees of freedom: position of the middle of the object's spots, turn since that first look.
///
/// The first look: what a box shows, or without one the biggest thing that moved, in the first
/// frame from learn_at_s on in which it has texture enough. From then on spots are looked for
/// around the last place, and where that fails in what moved, or in the whole picture if nothing
/// did. Without texture, without colour, or hidden: lost.
[[nodiscard]] std::unique_ptr<Tracker> make_texture_tracker(
    const RgbdCamera& camera, TrackedObjects<TextureSettings> objects
);

/// Refuses a box outside of the picture, fewest_spots not 4 to 1000.
[[nodiscard]] Result<void> check(
    const TextureSettings& settings, const RgbdCamera& camera, const std::string& path
);

}  // namespace kinectlab
