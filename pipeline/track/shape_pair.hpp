#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/track/shape_fit.hpp"

namespace kinectlab {

/// Two faces that meet at an edge, or three at a corner, as a rival of a round shape: a slim box
/// seen edge on is fitted by a cylinder within a few standard deviations, a corner by a cone. Keeps
/// its buffers. Not thread-safe.
class PlanePair {
public:
    explicit PlanePair(const RgbdCamera& camera);

    /// The mean of Tukey's loss over the pixels, each on the nearest of two or three planes that
    /// settle on them: comparable with ShapeFit::cost. 1 if no such planes do. The points are some
    /// of the pixels', their normals tell the planes apart at first.
    [[nodiscard]] double cost(
        const DisparityImage& image,
        std::span<const std::uint32_t> pixels,
        const SurfacePoints& points,
        int faces = 2
    );

private:
    static constexpr std::size_t kMost = 3;
    [[nodiscard]] static std::optional<std::array<Shape, kMost>> guess(
        const SurfacePoints& points, std::size_t faces
    );

    Pinhole camera_;
    DisparityScale scale_;
    ShapeFitter fitter_;
    std::array<std::vector<std::uint32_t>, kMost> shares_;
};

}  // namespace kinectlab
