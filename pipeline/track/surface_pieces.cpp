#include "pipeline/track/surface_pieces.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr double kJump_sigmas = 5.0;
constexpr double kSlope_steps = 1.5;  // of disparity a pixel, a steep surface

}  // namespace

SurfacePieces::SurfacePieces(const RgbdCamera& camera)
    : width_(camera.depth.width), height_(camera.depth.height), scale_(camera) {
    pixels_.reserve(static_cast<std::size_t>(width_ * height_));
}

bool SurfacePieces::continuous(std::uint16_t a, std::uint16_t b) const {
    if (b == 0) return false;
    const double s = scale_.steps(a);
    return std::abs(s - scale_.steps(b)) <= kJump_sigmas * scale_.sigma_at(s) + kSlope_steps;
}

std::span<const std::span<const std::uint32_t>> SurfacePieces::cut(
    std::span<const std::uint16_t> depth, std::span<std::uint8_t> mask, std::size_t fewest
) {
    pixels_.clear();
    pieces_.clear();
    const auto size = static_cast<std::uint32_t>(mask.size());
    const auto width = static_cast<std::uint32_t>(width_);
    for (std::uint32_t start = 0; start < size; ++start) {
        if (mask[start] == 0) continue;
        mask[start] = 0;
        if (depth[start] == 0) continue;
        const std::size_t first = pixels_.size();
        pixels_.push_back(start);
        for (std::size_t next = first; next < pixels_.size(); ++next) {
            const std::uint32_t at = pixels_[next];
            const std::uint32_t column = at % width;
            const auto visit = [&](std::uint32_t to) {
                if (mask[to] == 0 || !continuous(depth[at], depth[to])) return;
                mask[to] = 0;
                pixels_.push_back(to);
            };
            if (column > 0) visit(at - 1);
            if (column + 1 < width) visit(at + 1);
            if (at >= width) visit(at - width);
            if (at + width < size) visit(at + width);
        }
        if (pixels_.size() - first < fewest)
            pixels_.resize(first);
        else
            pieces_.emplace_back(pixels_.data() + first, pixels_.size() - first);
    }
    std::sort(pieces_.begin(), pieces_.end(), [](const auto& a, const auto& b) {
        return a.size() > b.size();
    });
    return pieces_;
}

}  // namespace kinectlab
