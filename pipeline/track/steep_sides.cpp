#include "pipeline/track/steep_sides.hpp"

#include <cmath>
#include <cstdlib>

namespace kinectlab {
namespace {

constexpr int kWidest_px = 4;

}  // namespace

SteepSides::SteepSides(const RgbdCamera& camera)
    : width_(camera.depth.width),
      depth_unit_m_(camera.depth_unit_m),
      taken_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)) {
    pixels_.reserve(taken_.size());
}

std::span<const std::uint32_t> SteepSides::join(
    std::span<const std::uint32_t> piece,
    std::span<const std::uint16_t> depth,
    std::span<const std::uint8_t> votes,
    std::uint8_t least,
    double area_m2
) {
    pixels_.assign(piece.begin(), piece.end());
    for (const auto pixel : pixels_)
        taken_[pixel] = 1;
    const int half_width = static_cast<int>(0.5 * std::sqrt(area_m2) / depth_unit_m_);
    const auto width = static_cast<std::uint32_t>(width_);
    std::size_t from = 0;
    for (int ring = 0; ring < kWidest_px; ++ring) {
        const std::size_t to = pixels_.size();
        for (std::size_t i = from; i < to; ++i) {
            const std::uint32_t at = pixels_[i];
            const auto visit = [&](std::uint32_t next) {
                if (taken_[next] != 0 || votes[next] < least || depth[next] == 0) return;
                if (std::abs(int{depth[next]} - int{depth[at]}) > half_width) return;
                taken_[next] = 1;
                pixels_.push_back(next);
            };
            if (at % width > 0) visit(at - 1);
            if (at % width + 1 < width) visit(at + 1);
            if (at >= width) visit(at - width);
            if (at + width < taken_.size()) visit(at + width);
        }
        from = to;
    }
    for (const auto pixel : pixels_)
        taken_[pixel] = 0;
    return pixels_;
}

}  // namespace kinectlab
