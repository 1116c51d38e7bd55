#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape_fit.hpp"

namespace kinectlab {

/// A plane as far as its surface goes on, from frame to frame: what lies in the same endless plane
/// elsewhere, where it cuts a wall, is none of it. Keeps its buffers. Not thread-safe.
class PlaneRegion {
public:
    explicit PlaneRegion(const RgbdCamera& camera);

    /// Grows from some pixels of a roughly known plane to all of its surface. Nothing, and what was
    /// followed before stays, where they belong to no flat piece.
    [[nodiscard]] std::optional<ShapeFit> grow(
        const DisparityImage& image, const Shape& rough, std::span<const std::uint32_t> pixels
    );

    /// The plane that was grown, refined on this frame; nothing where it is not seen.
    [[nodiscard]] std::optional<ShapeFit> follow(const DisparityImage& image);

    [[nodiscard]] bool is_grown() const { return plane_.has_value(); }
    void forget() { plane_.reset(); }

private:
    void find_near(const DisparityImage& image, const Shape& plane);
    void keep_connected(const std::vector<std::uint8_t>& known);
    void find_inner();
    [[nodiscard]] std::optional<ShapeFit> fit(
        const DisparityImage& image, const Shape& guess, std::span<const std::uint32_t> pixels
    );

    /// Where a row begins in near_: a column and a row about the picture stay 0, so that a pixel's
    /// neighbours need no thought.
    [[nodiscard]] std::uint32_t near_at(std::uint32_t row) const {
        return (row + 1) * (width_ + 1) + 1;
    }

    RgbdCamera camera_;
    DisparityScale scale_;
    ShapeFitter fitter_;
    std::uint32_t width_, height_;
    std::optional<Shape> plane_;
    std::vector<std::uint8_t> region_;  ///< of plane_, a byte a pixel
    std::vector<std::uint8_t> near_, growing_;
    std::vector<std::uint32_t> kept_, inner_;
};

}  // namespace kinectlab
