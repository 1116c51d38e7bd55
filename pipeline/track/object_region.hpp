#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/frame.hpp"
#include "pipeline/features/two_cameras.hpp"
#include "pipeline/track/surface_pieces.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Decides which depth pixels are an object when it is seen for the first time. Keeps its buffers.
class ObjectRegion {
public:
    explicit ObjectRegion(const RgbdCamera& camera);

    /// With a box: of what moved, the segment with most pixels in the box, if it fills a fifth of
    /// what the box shows; else the biggest piece of continuous surface within the box. Without:
    /// the `rank`-th biggest of what moved. Row-major indices of readings, in no order; empty if
    /// nothing is there. Valid until the next call.
    [[nodiscard]] std::span<const std::uint32_t> find(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        const std::optional<PictureBox>& box,
        std::size_t rank
    );

private:
    RgbdCamera camera_;
    TwoCameras cameras_;
    SurfacePieces pieces_;
    std::vector<std::int32_t> row_;
    std::vector<std::uint8_t> mask_;
    std::vector<std::uint32_t> pixels_;
};

}  // namespace kinectlab
