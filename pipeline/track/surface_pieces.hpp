#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"

namespace kinectlab {

/// Cuts a mask over the depth picture into pieces of continuous surface. Keeps its buffers.
class SurfacePieces {
public:
    explicit SurfacePieces(const RgbdCamera& camera);

    /// Pieces of at least `fewest` pixels, biggest first. `mask` has a byte a pixel and is cleared
    /// on the way. Neighbours belong together if their depths differ by no more than noise and a
    /// steep surface explain. Spans are valid until the next call.
    [[nodiscard]] std::span<const std::span<const std::uint32_t>> cut(
        std::span<const std::uint16_t> depth, std::span<std::uint8_t> mask, std::size_t fewest
    );

private:
    [[nodiscard]] bool continuous(std::uint16_t a, std::uint16_t b) const;

    int width_;
    int height_;
    DisparityScale scale_;
    std::vector<std::uint32_t> pixels_;
    std::vector<std::span<const std::uint32_t>> pieces_;
};

}  // namespace kinectlab
