#include "pipeline/track/object_region.hpp"

#include <algorithm>

namespace kinectlab {
namespace {

constexpr std::size_t kFewestPixels = 60;  // fewer are noise
constexpr std::size_t kShareOfBox = 5;     // what moved fills at least a fifth of the box

}  // namespace

ObjectRegion::ObjectRegion(const RgbdCamera& camera)
    : camera_(camera),
      cameras_(camera),
      pieces_(camera),
      row_(static_cast<std::size_t>(camera.depth.width)),
      mask_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)) {}

std::span<const std::uint32_t> ObjectRegion::find(
    const RgbdFrame& frame,
    std::span<const MovedPixels> moved,
    const std::optional<PictureBox>& box,
    std::size_t rank
) {
    pixels_.clear();
    if (!box) {
        if (rank < moved.size()) pixels_.assign(moved[rank].begin(), moved[rank].end());
        return pixels_;
    }
    std::size_t in_box = 0;
    const int width = camera_.depth.width;
    for (int v = 0; v < camera_.depth.height; ++v) {
        const auto first = static_cast<std::size_t>(v * width);
        cameras_.colour_indices(&frame.depth[first], 0, v, width, row_.data());
        for (std::size_t u = 0; u < row_.size(); ++u) {
            const int column = row_[u] % camera_.colour.width - box->left;
            const int line = row_[u] / camera_.colour.width - box->top;
            const bool inside = row_[u] >= 0 && column >= 0 && line >= 0 && column < box->width &&
                                line < box->height;
            mask_[first + u] = inside ? 1 : 0;
            in_box += inside ? 1 : 0;
        }
    }
    MovedPixels most;
    std::size_t most_inside = 0;
    for (const auto& segment : moved) {
        const auto inside = static_cast<std::size_t>(std::count_if(
            segment.begin(), segment.end(), [&](std::uint32_t pixel) { return mask_[pixel] != 0; }
        ));
        if (inside <= most_inside) continue;
        most_inside = inside;
        most = segment;
    }
    if (most_inside >= kFewestPixels && most_inside * kShareOfBox >= in_box) {
        std::copy_if(
            most.begin(),
            most.end(),
            std::back_inserter(pixels_),
            [&](std::uint32_t pixel) { return mask_[pixel] != 0; }
        );
        return pixels_;
    }
    const auto pieces = pieces_.cut(frame.depth, mask_, kFewestPixels);
    if (!pieces.empty()) pixels_.assign(pieces.front().begin(), pieces.front().end());
    return pixels_;
}

}  // namespace kinectlab
