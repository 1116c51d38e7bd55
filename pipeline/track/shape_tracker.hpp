#pragma once

#include "pipeline/track/shape_search.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// An object whose shape is a plane, sphere, cylinder or cone.
struct ShapeTarget {
    std::uint32_t index = 0;  ///< in the list that a person gave
    ShapeKind kind = ShapeKind::plane;
    SizeLimits limits;
    LookIn in = LookIn::moved;
    GuessBy search = GuessBy::ransac;
};

/// Methods "plane", "cylinder" and "cone", and "sphere" in a scene. Among what moved, a segment
/// gives a guess by RANSAC or Hough, which is refined along the viewing rays; in a scene the shapes
/// of the whole picture are found first and each object takes one of its kind. What a simpler shape
/// explains as well is refused. Objects of a kind keep their identity by staying near where they
/// were; a shape in the picture belongs to one object only.
///
/// The pose: a plane's place is the middle of what is seen of it and z its normal towards the
/// camera; a cylinder's the middle of the seen length and z its axis, upwards in the picture where
/// it is first seen; a cone's its apex and z the axis into the cone. The turn about z is not shown
/// by the shape: x is carried along without a turn, and the covariance says that it may be any.
[[nodiscard]] std::unique_ptr<Tracker> make_shape_tracker(
    const RgbdCamera& camera, std::vector<ShapeTarget> targets
);

/// Those among the objects that this tracker finds.
[[nodiscard]] std::vector<ShapeTarget> shape_targets(std::span<const ObjectSpec> objects);

/// A ball among what moved is the sphere tracker's, which knows more about whole balls.
[[nodiscard]] inline bool is_for_sphere_tracker(const SphereSettings& settings) {
    return settings.in == LookIn::moved && settings.search == GuessBy::ransac;
}

/// A radius that is not above 0 and at most 2 m, min_radius_m not below max_radius_m, an angle that
/// is not from 5° to 70°.
[[nodiscard]] Result<void> check(const PlaneSettings& settings, const std::string& path);
[[nodiscard]] Result<void> check(const CylinderSettings& settings, const std::string& path);
[[nodiscard]] Result<void> check(const ConeSettings& settings, const std::string& path);

}  // namespace kinectlab
