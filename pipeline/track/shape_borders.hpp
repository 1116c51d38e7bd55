#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shapes.hpp"

namespace kinectlab {

inline constexpr double kPixelSigmas = 4.0;  ///< of a pixel that belongs to a shape

/// By how many standard deviations a pixel reads nearer than the shape; NaN where its ray does not
/// meet the shape, or well beyond the ends that are seen of it.
[[nodiscard]] double off_in_sigmas(
    const ShapeFit& fit,
    const DisparityImage& image,
    const Pinhole& camera,
    const DisparityScale& scale,
    std::uint32_t pixel
);

/// Where shapes of a scene meet, the one that was found first has taken some pixels of the other.
/// Gives each pixel near a border to the shape that the readings around it lie nearer to. Keeps its
/// buffers. Not thread-safe.
class ShapeBorders {
public:
    explicit ShapeBorders(const RgbdCamera& camera);

    void share_out(const DisparityImage& image, std::span<SceneShape> shapes);

private:
    static constexpr int kCell = 4;       // px
    static constexpr int kNearCells = 2;  // as far as a shape may grow beyond its points

    void enter(std::span<const SceneShape> shapes);
    [[nodiscard]] std::uint64_t owners_near(int column, int row) const;
    void contest(
        const DisparityImage& image,
        std::span<const SceneShape> shapes,
        int column,
        int row,
        std::size_t owner,
        std::size_t rival
    );

    Pinhole camera_;
    DisparityScale scale_;
    int columns_, rows_;
    std::vector<std::int32_t> owner_, next_;  // of each pixel, -1 for none
    std::vector<std::uint64_t> owners_;       // of each cell, a bit for each of the first 64
};

}  // namespace kinectlab
