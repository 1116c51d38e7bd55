#include "pipeline/track/surface_vote.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr double kHalfWindow = 3.0 / 640.0;  // of the picture's width
constexpr double kJump_sigmas = 5.0;
constexpr double kSlope_steps = 1.5;  // of disparity a pixel, a steep surface

}  // namespace

SurfaceVote::SurfaceVote(const RgbdCamera& camera)
    : width_(camera.depth.width),
      height_(camera.depth.height),
      half_(std::max(1, static_cast<int>(std::lround(kHalfWindow * camera.depth.width)))),
      scale_(camera),
      steps_(static_cast<std::size_t>(width_ * height_)),
      sum_(static_cast<std::size_t>((width_ + 1) * (height_ + 1))) {}

void SurfaceVote::look(std::span<const std::uint16_t> depth) {
    const auto product = static_cast<float>(scale_.product);
    for (std::size_t i = 0; i < steps_.size(); ++i)
        steps_[i] = depth[i] == 0 ? 0.0F : product / static_cast<float>(depth[i]);
}

void SurfaceVote::count(
    std::span<const std::uint8_t> mask, const PixelArea& area, std::span<std::uint8_t> votes
) {
    std::fill(votes.begin(), votes.end(), std::uint8_t{0});
    const auto sum_at = [&](int column, int row) -> std::int32_t& {
        return sum_[static_cast<std::size_t>(row * (width_ + 1) + column)];
    };
    const int left = std::max(0, area.left - half_), right = std::min(width_, area.right + half_);
    const int top = std::max(0, area.top - half_), bottom = std::min(height_, area.bottom + half_);
    for (int u = left; u <= right; ++u)
        sum_at(u, top) = 0;
    for (int v = top; v < bottom; ++v) {
        std::int32_t row = 0;
        sum_at(left, v + 1) = 0;
        for (int u = left; u < right; ++u) {
            row += mask[static_cast<std::size_t>(v * width_ + u)];
            sum_at(u + 1, v + 1) = sum_at(u + 1, v) + row;
        }
    }
    for (int v = area.top; v < area.bottom; ++v)
        for (int u = area.left; u < area.right; ++u) {
            const auto at = static_cast<std::size_t>(v * width_ + u);
            if (steps_[at] <= 0.0F) continue;
            const int u0 = std::max(left, u - half_), u1 = std::min(right, u + half_ + 1);
            const int v0 = std::max(top, v - half_), v1 = std::min(bottom, v + half_ + 1);
            const std::int32_t passing =
                sum_at(u1, v1) - sum_at(u0, v1) - sum_at(u1, v0) + sum_at(u0, v0);
            if (passing == 0) continue;
            votes[at] =
                passing == (u1 - u0) * (v1 - v0) ? std::uint8_t{255} : own_share(mask, u, v);
        }
}

std::uint8_t SurfaceVote::own_share(std::span<const std::uint8_t> mask, int column, int row) const {
    const float own = steps_[static_cast<std::size_t>(row * width_ + column)];
    const auto noise = static_cast<float>(kJump_sigmas * scale_.sigma_at(own));
    const int u0 = std::max(0, column - half_), u1 = std::min(width_, column + half_ + 1);
    const int v0 = std::max(0, row - half_), v1 = std::min(height_, row + half_ + 1);
    int voters = 0, passing = 0;
    for (int v = v0; v < v1; ++v)
        for (int u = u0; u < u1; ++u) {
            const auto at = static_cast<std::size_t>(v * width_ + u);
            const auto far = static_cast<float>(std::max(std::abs(u - column), std::abs(v - row)));
            const float jump = std::abs(steps_[at] - own);
            if (steps_[at] <= 0.0F || jump > noise + static_cast<float>(kSlope_steps) * far)
                continue;
            ++voters;
            passing += mask[at];
        }
    return static_cast<std::uint8_t>(255 * passing / std::max(1, voters));
}

}  // namespace kinectlab
