#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/track/shape.hpp"

namespace kinectlab::bench {

/// What the Point Cloud Library's SACSegmentationFromNormals makes of a region of interest: 1000
/// RANSAC iterations, 10 mm, coefficients refined. Normals by NormalEstimation with 50 neighbours.
struct StockShape {
    std::optional<Shape> shape;
    double normals_ms = 0.0;
    double segmentation_ms = 0.0;
};
[[nodiscard]] StockShape stock_shape(
    const RgbdCamera& camera,
    const RgbdFrame& frame,
    std::span<const std::uint32_t> pixels,
    ShapeKind kind
);

}  // namespace kinectlab::bench
