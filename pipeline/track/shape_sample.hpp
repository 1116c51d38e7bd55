#pragma once

#include <optional>
#include <span>

#include "pipeline/features/normal.hpp"
#include "pipeline/track/shape.hpp"

namespace kinectlab {

/// The paper's minimal samples (its Table I): how many oriented points make one shape.
[[nodiscard]] constexpr std::size_t sample_size(ShapeKind kind) {
    return kind == ShapeKind::plane || kind == ShapeKind::cone ? 3 : 2;
}

/// The shape through a minimal sample, or nothing where the sample does not determine one: points
/// on one line, normals that are parallel or that the shape would have to show from inside.
///   plane:    through three points; the normal towards the camera.
///   sphere:   centre in the middle of the shortest segment between the normals' lines, r the mean
///             distance to it.
///   cylinder: axis along n1 x n2, then the circle in the plane across the axis.
///   cone:     apex where the three tangent planes meet, axis across the tips of the unit vectors
///             from the apex to the points, angle the mean of those vectors' angles to the axis.
/// Whether the normals agree with the shape is the score's to tell.
[[nodiscard]] std::optional<Shape> through_sample(
    ShapeKind kind, std::span<const OrientedPoint> sample
);

}  // namespace kinectlab
