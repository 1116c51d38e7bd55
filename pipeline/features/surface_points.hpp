#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/features/normal.hpp"

namespace kinectlab {

/// A depth picture in disparity steps within a margin of zeros, so that no window needs clipping;
/// 0 = no reading. Keeps its buffer: no allocation after the constructor.
class DisparityImage {
public:
    explicit DisparityImage(const RgbdCamera& camera);

    /// `depth` is the camera's whole picture; only the rows first to last are converted, the others
    /// keep what they held.
    void load(std::span<const std::uint16_t> depth, int first_row, int last_row);
    void load(std::span<const std::uint16_t> depth) { load(depth, 0, height_ - 1); }
    /// Only the smallest box that holds all windows about some pixels.
    void load_around(std::span<const std::uint16_t> depth, std::span<const std::uint32_t> pixels);

    [[nodiscard]] const float* row(int v) const {
        return steps_.data() + static_cast<std::ptrdiff_t>(v + kMargin) * stride_ + kMargin;
    }
    [[nodiscard]] float at(std::uint32_t pixel) const {
        const auto width = static_cast<std::uint32_t>(width_);
        return row(static_cast<int>(pixel / width))[pixel % width];
    }

    static constexpr int kMostHalfWindow = 7;

private:
    void load_box(std::span<const std::uint16_t> depth, int left, int right, int top, int bottom);

    static constexpr int kMargin = 16;
    int width_, height_, stride_;
    float product_;
    std::vector<float> steps_;
};

/// Oriented points as a structure of arrays, camera frame, metres. The arrays are padded with NaN
/// to a multiple of kLanes.
struct SurfacePoints {
    std::vector<float> px, py, pz;
    std::vector<float> nx, ny, nz;     ///< unit, towards the camera
    std::vector<float> sigma;          ///< of one reading there, along the normal, m
    std::vector<std::uint32_t> pixel;  ///< row-major index of the window's middle
    std::size_t size = 0;              ///< without the padding

    static constexpr std::size_t kLanes = 8;

    void clear();
    void reserve(std::size_t points);
    void pad();
    /// Takes over one point of another list; pad() when all are there.
    void copy(const SurfacePoints& other, std::size_t i);
    [[nodiscard]] OrientedPoint at(std::size_t i) const;
};

/// The points and normals at some pixels: the plane s = a du + b dv + c of least squares in
/// disparity through the neighbours within half_window (at most kMostHalfWindow) pixels that have
/// readings within max_jump_steps of the pixel's own. No point where the pixel has no reading, less
/// than half of the window remains, or the neighbours lie on no plane (an edge). Replaces `points`.
void find_surface_points(
    const DisparityImage& image,
    const RgbdCamera& camera,
    std::span<const std::uint32_t> pixels,
    int half_window,
    SurfacePoints& points
);

}  // namespace kinectlab
