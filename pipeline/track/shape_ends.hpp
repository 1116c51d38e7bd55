#pragma once

#include <optional>

#include "pipeline/track/shape_pixels.hpp"

namespace kinectlab {

/// From here to there along a shape's axis, m.
struct ShapeEnds {
    double low = 0.0, high = 0.0;
};

/// Where along the axis a shape is seen: heights at which most rays that meet it read it within the
/// gate, less the margin at both ends. Beyond are lids, tables and hands, some of whose pixels lie
/// near the surface by chance and would pull. Nothing if they show no length.
[[nodiscard]] std::optional<ShapeEnds> seen_ends(
    const ShapePixels& pixels, double gate_steps, double margin_m
);

}  // namespace kinectlab
