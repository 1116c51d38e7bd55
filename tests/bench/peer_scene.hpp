#pragma once

#include <optional>
#include <vector>

#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape.hpp"

namespace kinectlab::bench {

/// What CGAL's Efficient_RANSAC finds among oriented points: epsilon 10 mm, normals within 25°,
/// clusters of 20 mm, at least 500 points, 1 % to miss a shape.
struct StockScene {
    struct Found {
        Shape shape;
        std::vector<std::uint32_t> pixels;
    };
    std::vector<Found> shapes;
    double ms = 0.0;
};

/// Nothing where the program was built without CGAL (libcgal-dev).
[[nodiscard]] std::optional<StockScene> stock_scene(const SurfacePoints& points);

}  // namespace kinectlab::bench
