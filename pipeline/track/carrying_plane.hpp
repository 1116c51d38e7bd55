#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "plane" with `under`: the plane that a ball touches, as a plank on which it rolls or the
/// table on which it lies. Found where the ball is, then followed as far as its surface goes on,
/// also while the ball is not seen; another plane takes its place once the ball touches that one
/// and no longer the first. Without a ball that ever touched one it is lost: the biggest plane in
/// view is never taken for it.
///
/// `samples`, when tracking, holds the balls' samples of the same frame. The pose is that of a
/// plane as ShapeTracker tells it; x points to the right in the picture.
[[nodiscard]] std::unique_ptr<Tracker> make_carrying_plane_tracker(
    const RgbdCamera& camera, std::span<const ObjectSpec> objects
);

/// Whether an object is for this tracker.
[[nodiscard]] inline bool is_carrying(const ObjectSpec& object) {
    const auto* plane = std::get_if<PlaneSettings>(&object.settings);
    return plane != nullptr && !plane->under.empty();
}

/// Refuses an `under` that names no ball of the list.
[[nodiscard]] Result<void> check_carrying_planes(std::span<const ObjectSpec> objects);

}  // namespace kinectlab
