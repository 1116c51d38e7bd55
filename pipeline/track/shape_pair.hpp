#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/track/shape_fit.hpp"

namespace kinectlab {

/// Two faces that meet at an edge, as a rival of a round shape: a slim box seen edge on is fitted
/// by a cylinder within a few standard deviations. Keeps its buffers. Not thread-safe.
class PlanePair {
public:
    explicit PlanePair(const RgbdCamera& camera);

    /// The mean of Tukey's loss over the pixels, each on the nearer of two planes that settle on
    /// them: comparable with ShapeFit::cost. 1 if no two planes do. The points are some of the
    /// pixels', their normals tell the planes apart at first.
    [[nodiscard]] double cost(
        const DisparityImage& image,
        std::span<const std::uint32_t> pixels,
        const SurfacePoints& points
    );

private:
    [[nodiscard]] static std::optional<std::array<Shape, 2>> guess(const SurfacePoints& points);

    Pinhole camera_;
    DisparityScale scale_;
    ShapeFitter fitter_;
    std::array<std::vector<std::uint32_t>, 2> shares_;
};

}  // namespace kinectlab
