#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/features/normal.hpp"
#include "pipeline/track/object_spec.hpp"
#include "pipeline/track/sphere_model.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Points with normals drawn from one moving segment, the same number whatever its size.
class SurfaceSample {
public:
    SurfaceSample(
        std::span<const std::uint16_t> depth,
        MovedPixels pixels,
        const Pinhole& camera,
        const DisparityScale& scale
    );
    [[nodiscard]] std::span<const OrientedPoint> points() const { return {points_.data(), size_}; }

    static constexpr std::size_t kPoints = 64;

private:
    std::array<OrientedPoint, kPoints> points_;
    std::size_t size_ = 0;
};

/// Share of the points that lie on a sphere: within ε along the viewing ray and with a normal
/// within α of the sphere's (the paper's Table I, acceptance).
[[nodiscard]] double support(
    const Sphere& sphere, std::span<const OrientedPoint> points, const DisparityScale& scale
);

/// The sphere that most points support, by RANSAC on pairs of points with normals: the centre is
/// the midpoint of the shortest segment between the two normals' lines, the radius the mean
/// distance (the paper's Table I). Nothing where no pair gives a radius in range. Deterministic.
[[nodiscard]] std::optional<Sphere> sphere_candidate(
    std::span<const OrientedPoint> points,
    const SphereSettings& settings,
    const DisparityScale& scale
);

}  // namespace kinectlab
