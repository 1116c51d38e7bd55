#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"

namespace kinectlab {

/// A part of the depth picture, px; right and bottom lie outside.
struct PixelArea {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// Turns a mask that noise and print have torn into one of whole patches: each pixel is decided by
/// the share that passes among the pixels around it on its own surface. What lies beyond a jump of
/// the depth has no vote, so where a thing ends in space its outline is the depth's, and the mixed
/// colours of its edge do not matter. Keeps its buffers.
class SurfaceVote {
public:
    explicit SurfaceVote(const RgbdCamera& camera);

    /// To be called for each new depth picture.
    void look(std::span<const std::uint16_t> depth);

    /// Sets `votes` (a byte a pixel) to the share that passes, 0 to 255, within `area` and to 0
    /// elsewhere. `mask` is 0 where there is no reading.
    void count(
        std::span<const std::uint8_t> mask, const PixelArea& area, std::span<std::uint8_t> votes
    );

    [[nodiscard]] int half_window() const { return half_; }

private:
    [[nodiscard]] std::uint8_t own_share(std::span<const std::uint8_t> mask, int column, int row)
        const;

    int width_, height_, half_;
    DisparityScale scale_;
    std::vector<float> steps_;       // 0 without a reading
    std::vector<std::int32_t> sum_;  // of the mask, above and left of each pixel
};

}  // namespace kinectlab
