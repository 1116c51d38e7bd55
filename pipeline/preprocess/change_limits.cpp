#include "pipeline/preprocess/change_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/preprocess/depth_cut.hpp"

namespace kinectlab {
namespace {

// Edges in the scene jitter by a pixel or two from frame to frame, so a reading must be nearer than
// everything that the reference shows within this many pixels.
constexpr int kJitterPx = 2;
constexpr int kWindow = 2 * kJitterPx + 1;
constexpr int kWidestShadowPx = 80;  // a Kinect's shadow: 43 px at most, before infinity at 1 m
constexpr float kSpreadSigmas = 5.0F;
constexpr float kMaxWidening = 2.0F;  // a noisy pixel never asks for more than twice the threshold
constexpr float kNoLimit = 65535.0F;

/// How much nearer than its reference a reading must be at each pixel, in steps, without rounding.
KINECTLAB_HOT_LOOP void slack_of(
    const float* __restrict variance,
    const std::uint8_t* __restrict seen,
    float* __restrict slack,
    std::size_t size,
    float threshold
) {
    for (std::size_t x = 0; x < size; ++x) {
        const float spread = kSpreadSigmas * std::sqrt(variance[x]);
        const float steady = std::min(kMaxWidening * threshold, std::max(threshold, spread));
        const float readings = static_cast<float>(std::max<int>(1, seen[x]));
        slack[x] = steady * std::sqrt(1.0F + 1.0F / readings);
    }
}

/// The nearest disparity that still belongs to the scene at each pixel; 0 where nothing is known.
KINECTLAB_HOT_LOOP void add_slack(
    float* __restrict filled, const float* __restrict slack, std::size_t size, float rounding
) {
    for (std::size_t x = 0; x < size; ++x) {
        const float s = filled[x];
        const float nearest = s + slack[x] + kSpreadSigmas * rounding * s * s;
        filled[x] = s > 0.0F ? nearest : 0.0F;
    }
}

KINECTLAB_HOT_LOOP void widen(const float* __restrict row, float* __restrict wide, int width) {
    for (int x = kJitterPx; x < width - kJitterPx; ++x) {
        const float left = std::max(row[x - 2], row[x - 1]);
        const float right = std::max(row[x + 1], row[x + 2]);
        wide[x] = std::max(row[x], std::max(left, right));
    }
}

void widen_border(std::span<const float> row, std::span<float> wide) {
    const int width = static_cast<int>(row.size());
    const auto widen_at = [&](int x) {
        const int first = std::max(0, x - kJitterPx), last = std::min(width - 1, x + kJitterPx);
        wide[static_cast<std::size_t>(x)] =
            *std::max_element(row.begin() + first, row.begin() + last + 1);
    };
    for (int x = 0; x < std::min(kJitterPx, width); ++x)
        widen_at(x);
    for (int x = std::max(kJitterPx, width - kJitterPx); x < width; ++x)
        widen_at(x);
}

using WindowRows = std::array<const float*, kWindow>;

KINECTLAB_HOT_LOOP void limits_of(
    const WindowRows& rows,
    std::uint16_t* __restrict reach,
    int width,
    float product,
    float cut,
    float cut_per_column
) {
    const float *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3], *e = rows[4];
    for (int x = 0; x < width; ++x) {
        const float scene = std::max(std::max(std::max(a[x], b[x]), std::max(d[x], e[x])), c[x]);
        const float end = std::max(0.0F, cut + cut_per_column * static_cast<float>(x));
        const float nearest = std::max(scene, end);
        // Division by 0, where nothing is known and nothing cut away, is no limit.
        const float counts = std::min(kNoLimit, product / nearest);
        reach[x] = static_cast<std::uint16_t>(static_cast<int>(std::max(counts, 1.0F)) - 1);
    }
}

}  // namespace

ChangeLimits::ChangeLimits(
    const RgbdCamera& camera, double threshold_steps, const DepthCutSettings& cut
)
    : width_(camera.depth.width),
      height_(camera.depth.height),
      scale_(camera),
      threshold_steps_(static_cast<float>(threshold_steps)),
      cut_settings_(cut) {
    const auto row = static_cast<std::size_t>(width_), rows = static_cast<std::size_t>(height_);
    reach_.assign(row * rows, 0);
    trusted_.assign(row * rows, 1);
    nearest_rows_.assign(row * rows, 0.0F);
    slack_.assign(row * rows, threshold_steps_);
    filled_.assign(row, 0.0F);
}

void ChangeLimits::rebuild(const SceneView& reference) {
    cut_ = std::nullopt;
    if (cut_settings_.method == CutMethod::wall) cut_ = wall_cut(reference.disparity, width_);
    if (cut_settings_.method == CutMethod::fixed)
        cut_ = DepthCut{scale_.steps_at(cut_settings_.farthest_m), 0.0, 0.0};
    slack_of(
        reference.variance.data(),
        reference.seen.data(),
        slack_.data(),
        slack_.size(),
        threshold_steps_
    );
    update(reference, {0, height_});
}

void ChangeLimits::update(const SceneView& reference, RowRange rows) {
    const auto row_of = [this](int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
    };
    for (int row = rows.first; row < rows.last; ++row)
        nearest_row(
            reference,
            row,
            std::span(nearest_rows_).subspan(row_of(row), static_cast<std::size_t>(width_))
        );

    const DepthCut cut = cut_.value_or(DepthCut{});
    const int first = std::max(0, rows.first - kJitterPx);
    const int last = std::min(height_, rows.last + kJitterPx);
    for (int row = first; row < last; ++row) {
        WindowRows window{};
        for (int k = 0; k < kWindow; ++k)
            window[static_cast<std::size_t>(k)] =
                nearest_rows_.data() + row_of(std::clamp(row + k - kJitterPx, 0, height_ - 1));
        limits_of(
            window,
            reach_.data() + row_of(row),
            width_,
            static_cast<float>(scale_.product),
            static_cast<float>(cut.steps(0, row)),
            static_cast<float>(cut.per_column)
        );
    }
}

void ChangeLimits::nearest_row(const SceneView& reference, int row, std::span<float> nearest) {
    const auto size = static_cast<std::size_t>(width_);
    const auto first = static_cast<std::size_t>(row) * size;
    const auto disparity = reference.disparity.subspan(first, size);
    std::copy(disparity.begin(), disparity.end(), filled_.begin());
    fill_holes(filled_, std::span(trusted_).subspan(first, size));
    const auto rounding = static_cast<float>(scale_.rounding_steps(1.0));
    add_slack(filled_.data(), slack_.data() + first, size, rounding);
    widen(filled_.data(), nearest.data(), width_);
    widen_border(filled_, nearest);
}

/// A hole as narrow as a shadow takes the farther of its two sides; a wider one stays unknown, so
/// that an object before an invalid background still counts.
void ChangeLimits::fill_holes(std::span<float> row, std::span<std::uint8_t> trusted) {
    const auto none = [](float s) {
        return s == 0.0F;
    };
    std::fill(trusted.begin(), trusted.end(), std::uint8_t{1});
    auto hole = std::find_if(row.begin(), row.end(), none);
    while (hole != row.end()) {
        const auto end = std::find_if_not(hole, row.end(), none);
        const float left = hole == row.begin() ? 0.0F : *(hole - 1);
        const float right = end == row.end() ? 0.0F : *end;
        const float side = left > 0.0F && right > 0.0F ? std::min(left, right) : left + right;
        if (end - hole <= kWidestShadowPx) {
            std::fill(hole, end, side);
            const auto first = trusted.begin() + (hole - row.begin());
            std::fill(first, first + (end - hole), std::uint8_t{0});
        }
        hole = std::find_if(end, row.end(), none);
    }
}

}  // namespace kinectlab
