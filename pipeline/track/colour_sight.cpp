#include "pipeline/track/colour_sight.hpp"

#include <algorithm>

namespace kinectlab {
namespace {

/// Half of an outline's vote, and never none.
std::uint8_t least_vote(double half_vote) {
    return static_cast<std::uint8_t>(std::max(1.0, 0.5 * half_vote) + 1.0);
}

}  // namespace

ColourSight::ColourSight(const RgbdCamera& camera)
    : camera_(camera),
      cameras_(camera),
      pieces_(camera),
      sides_(camera),
      vote_(camera),
      colour_index_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)),
      mask_(colour_index_.size()),
      votes_(colour_index_.size()),
      patch_(colour_index_.size()) {}

void ColourSight::look(const RgbdFrame& frame) {
    frame_ = &frame;
    if (!constancy_.has_reference()) constancy_.learn(frame.rgb, camera_.colour.width);
    gains_ = constancy_.gains(frame.rgb);
    entry_ = ColourTable::entry(gains_);
    vote_.look(frame.depth);
    const int width = camera_.depth.width;
    for (int v = 0; v < camera_.depth.height; ++v) {
        const auto row = static_cast<std::size_t>(v * width);
        cameras_.colour_indices(&frame.depth[row], 0, v, width, &colour_index_[row]);
    }
}

bool ColourSight::passes(const ColourTable& table, std::size_t pixel) const {
    const std::int32_t at = colour_index_[pixel];
    return at >= 0 && table.passes(entry_, frame_->rgb.data() + std::ptrdiff_t{3} * at);
}

std::span<const MovedPixels> ColourSight::patches(
    const ColourTable& table, double half_vote, const PixelArea& area, std::size_t fewest
) {
    const int margin = vote_.half_window();
    const PixelArea wider{
        std::max(0, area.left - margin),
        std::max(0, area.top - margin),
        std::min(camera_.depth.width, area.right + margin),
        std::min(camera_.depth.height, area.bottom + margin)};
    for (int v = wider.top; v < wider.bottom; ++v)
        for (int u = wider.left; u < wider.right; ++u) {
            const auto i = static_cast<std::size_t>(v * camera_.depth.width + u);
            mask_[i] = passes(table, i) ? 1 : 0;
        }
    vote_.count(mask_, area, votes_);
    std::fill(patch_.begin(), patch_.end(), std::uint8_t{0});
    const std::uint8_t least = least_vote(half_vote);
    for (int v = area.top; v < area.bottom; ++v)
        for (int u = area.left; u < area.right; ++u) {
            const auto i = static_cast<std::size_t>(v * camera_.depth.width + u);
            patch_[i] = votes_[i] >= least ? 1 : 0;
        }
    return pieces_.cut(frame_->depth, patch_, fewest);
}

MovedPixels ColourSight::with_sides(MovedPixels patch, double half_vote, double area_m2) {
    return sides_.join(patch, frame_->depth, votes_, least_vote(half_vote), area_m2);
}

std::size_t ColourSight::passing(const ColourTable& table, MovedPixels pixels) const {
    return static_cast<std::size_t>(std::count_if(
        pixels.begin(), pixels.end(), [&](std::uint32_t pixel) { return passes(table, pixel); }
    ));
}

PixelArea ColourSight::whole_picture() const {
    return {0, 0, camera_.depth.width, camera_.depth.height};
}

PixelArea ColourSight::around(MovedPixels pixels) const {
    PixelArea area{camera_.depth.width, camera_.depth.height, 0, 0};
    for (const auto pixel : pixels) {
        const int u = static_cast<int>(pixel) % camera_.depth.width;
        const int v = static_cast<int>(pixel) / camera_.depth.width;
        area.left = std::min(area.left, u), area.right = std::max(area.right, u + 1);
        area.top = std::min(area.top, v), area.bottom = std::max(area.bottom, v + 1);
    }
    return area;
}

}  // namespace kinectlab
