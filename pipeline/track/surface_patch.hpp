#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "surface_patch": each object is a rigid thing of any shape, known by a model. It is
/// recognised anywhere in the picture by its local surface patches, then followed from frame to
/// frame from where it was, and recognised anew where it is lost. The pose is that of the model's
/// own frame; for a shape that does not show a rotation, such as a bottle's about its axis,
/// has_orientation is false, and of the equal poses of a symmetric one any may be found, then kept.
/// Errors name the object: a model without a surface, or without any patch to be recognised by.
[[nodiscard]] Result<std::unique_ptr<Tracker>> make_surface_patch_tracker(
    const RgbdCamera& camera, TrackedObjects<SurfacePatchSettings> objects
);

/// Refuses a model that was not loaded and a unit that is not above 0.
[[nodiscard]] Result<void> check(const SurfacePatchSettings& settings, const std::string& path);

}  // namespace kinectlab
