#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "sphere": each object is a sphere of known radius or of one between two bounds. A segment
/// that moved gives a candidate by RANSAC, the candidate is refined along the viewing rays, and
/// what does not look like one whole sphere standing alone is refused. Several spheres keep their
/// identity by staying near where they were; a sphere in the picture belongs to one object only.
[[nodiscard]] std::unique_ptr<Tracker> make_sphere_tracker(
    const RgbdCamera& camera, TrackedObjects<SphereSettings> objects
);

/// Refuses a radius that is not above 0 and at most 2 m, and min_radius_m not below max_radius_m.
[[nodiscard]] Result<void> check(const SphereSettings& settings, const std::string& path);

}  // namespace kinectlab
