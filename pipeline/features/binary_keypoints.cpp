#include "pipeline/features/binary_keypoints.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr int kPatch = 15;  // px around a corner that its description reads
constexpr int kBorder = kPatch + 2;
constexpr int kArc = 9;  // pixels of the ring in a row
constexpr float kSmooth_px = 1.8F;
constexpr float kSpread_px = 5.5F;  // σ of the pattern's points

constexpr std::array<std::array<int, 2>, 16> kRing{{
    {0, -3},
    {1, -3},
    {2, -2},
    {3, -1},
    {3, 0},
    {3, 1},
    {2, 2},
    {1, 3},
    {0, 3},
    {-1, 3},
    {-2, 2},
    {-3, 1},
    {-3, 0},
    {-3, -1},
    {-2, -2},
    {-1, -3},
}};

/// By linear interpolation between pixels, to any size.
void resize(const GreyImage& from, float ratio, GreyImage& to) {
    to.resize(
        std::max(1, static_cast<int>(static_cast<float>(from.width) / ratio)),
        std::max(1, static_cast<int>(static_cast<float>(from.height) / ratio))
    );
    for (int v = 0; v < to.height; ++v) {
        const float y = (static_cast<float>(v) + 0.5F) * ratio - 0.5F;
        const int y0 = std::clamp(static_cast<int>(y), 0, from.height - 1);
        const float fy = std::clamp(y - static_cast<float>(y0), 0.0F, 1.0F);
        const float* a = from.row(y0);
        const float* b = from.row(std::min(y0 + 1, from.height - 1));
        float* out = to.row(v);
        for (int u = 0; u < to.width; ++u) {
            const float x = (static_cast<float>(u) + 0.5F) * ratio - 0.5F;
            const int x0 = std::clamp(static_cast<int>(x), 0, from.width - 1);
            const int x1 = std::min(x0 + 1, from.width - 1);
            const float fx = std::clamp(x - static_cast<float>(x0), 0.0F, 1.0F);
            const float upper = a[x0] + fx * (a[x1] - a[x0]);
            const float lower = b[x0] + fx * (b[x1] - b[x0]);
            out[u] = upper + fy * (lower - upper);
        }
    }
}

/// Whether a run of kArc set bits lies in a ring of 16.
bool has_arc(std::uint32_t ring) {
    ring |= ring << 16U;
    std::uint32_t runs = ring;
    for (int i = 1; i < kArc; ++i)
        runs &= ring >> i;
    return (runs & 0xffffU) != 0;
}

/// FAST's score: by how much the arc differs at least, 0 for no corner.
float corner_score(const GreyImage& image, int u, int v, float least) {
    const float middle = image.row(v)[u];
    // Of four pixels a quarter turn apart, an arc of 9 holds two at least.
    int brighter = 0, darker = 0;
    for (std::size_t i = 0; i < 16; i += 4) {
        const float other = image.row(v + kRing[i][1])[u + kRing[i][0]] - middle;
        brighter += other > least ? 1 : 0;
        darker += other < -least ? 1 : 0;
    }
    if (brighter < 2 && darker < 2) return 0.0F;
    std::uint32_t above = 0, below = 0;
    float sum_above = 0.0F, sum_below = 0.0F;
    for (std::size_t i = 0; i < 16; ++i) {
        const float other = image.row(v + kRing[i][1])[u + kRing[i][0]] - middle;
        if (other > least) above |= 1U << i, sum_above += other - least;
        if (other < -least) below |= 1U << i, sum_below -= other + least;
    }
    float score = 0.0F;
    if (has_arc(above)) score = sum_above;
    if (has_arc(below)) score = std::max(score, sum_below);
    return score;
}

/// From the corner to the centroid of brightness in a disc around it.
float centroid_angle(const GreyImage& image, int u, int v) {
    float x = 0.0F, y = 0.0F;
    for (int dv = -kPatch; dv <= kPatch; ++dv) {
        const int half = static_cast<int>(std::sqrt(static_cast<float>(kPatch * kPatch - dv * dv)));
        const float* row = image.row(v + dv) + u;
        float line = 0.0F;
        for (int du = -half; du <= half; ++du) {
            x += static_cast<float>(du) * row[du];
            line += row[du];
        }
        y += static_cast<float>(dv) * line;
    }
    return std::atan2(y, x);
}

/// Offset of a peak between three values, half a pixel at most.
float peak_offset(float before, float here, float after) {
    const float bend = before - 2.0F * here + after;
    return bend < 0.0F ? std::clamp(0.5F * (before - after) / bend, -0.5F, 0.5F) : 0.0F;
}

}  // namespace

BinaryKeypoints::BinaryKeypoints(const BinarySettings& settings) : settings_(settings) {
    // Any fixed random pattern does; sums of uniform numbers are near enough to a Gaussian.
    std::uint64_t state = 0x9e3779b97f4a7c15ULL;
    const auto uniform = [&] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<float>(state >> 40U) / static_cast<float>(1U << 24U) - 0.5F;
    };
    const auto offset = [&] {
        const float sum = uniform() + uniform() + uniform();  // variance 1/4
        return std::clamp(2.0F * kSpread_px * sum, -10.0F, 10.0F);
    };
    for (auto& pair : pattern_)
        pair = {offset(), offset(), offset(), offset()};
    levels_.resize(static_cast<std::size_t>(settings.levels));
    smooth_.resize(levels_.size());
}

void BinaryKeypoints::find(
    std::span<const std::uint8_t> rgb, int width, const ImageRegion& region
) {
    keypoints_.clear();
    descriptors_.clear();
    if (region.right - region.left < 48 || region.bottom - region.top < 48) return;
    grey_of(rgb, width, region, levels_[0]);
    float ratio = 1.0F;
    for (int level = 0; level < settings_.levels; ++level, ratio *= settings_.level_ratio) {
        const auto i = static_cast<std::size_t>(level);
        if (level > 0) resize(levels_[i - 1], settings_.level_ratio, levels_[i]);
        blur(levels_[i], kSmooth_px, smooth_[i], scratch_);
        find_corners(level, ratio, region);
    }
    const auto most = static_cast<std::size_t>(settings_.most_keypoints);
    if (keypoints_.size() > most) {
        std::nth_element(
            keypoints_.begin(),
            keypoints_.begin() + static_cast<std::ptrdiff_t>(most),
            keypoints_.end(),
            [](const Keypoint2d& a, const Keypoint2d& b) { return a.response > b.response; }
        );
        keypoints_.resize(most);
    }
    descriptors_.resize(keypoints_.size());
    for (std::size_t i = 0; i < keypoints_.size(); ++i) {
        auto& keypoint = keypoints_[i];
        keypoint.angle_rad = centroid_angle(
            smooth_[keypoint.layer],
            static_cast<int>(std::lround(keypoint.x)),
            static_cast<int>(std::lround(keypoint.y))
        );
        describe(keypoint, descriptors_[i]);
    }
}

void BinaryKeypoints::find_corners(int level, float ratio, const ImageRegion& region) {
    const GreyImage& image = levels_[static_cast<std::size_t>(level)];
    if (image.width <= 2 * kBorder || image.height <= 2 * kBorder) return;
    const auto width = static_cast<std::size_t>(image.width);
    scores_.assign(width * static_cast<std::size_t>(image.height), 0.0F);
    for (int v = kBorder - 1; v < image.height - kBorder + 1; ++v)
        for (int u = kBorder - 1; u < image.width - kBorder + 1; ++u)
            scores_[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)] =
                corner_score(image, u, v, settings_.least_contrast);
    for (int v = kBorder; v < image.height - kBorder; ++v)
        for (int u = kBorder; u < image.width - kBorder; ++u) {
            const float* at =
                &scores_[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)];
            const float here = *at;
            if (here <= 0.0F) continue;
            const auto w = static_cast<std::ptrdiff_t>(width);
            if (here <= at[-1] || here < at[1] || here <= at[-w] || here < at[w] ||
                here <= at[-w - 1] || here <= at[-w + 1] || here < at[w - 1] || here < at[w + 1])
                continue;
            Keypoint2d found;
            found.x = static_cast<float>(u) + peak_offset(at[-1], here, at[1]);
            found.y = static_cast<float>(v) + peak_offset(at[-w], here, at[w]);
            found.u = (found.x + 0.5F) * ratio - 0.5F + static_cast<float>(region.left);
            found.v = (found.y + 0.5F) * ratio - 0.5F + static_cast<float>(region.top);
            found.scale_px = ratio;
            found.response = here;
            found.layer = static_cast<std::uint8_t>(level);
            keypoints_.push_back(found);
        }
}

void BinaryKeypoints::describe(const Keypoint2d& keypoint, Descriptor& descriptor) const {
    const GreyImage& image = smooth_[keypoint.layer];
    const float c = std::cos(keypoint.angle_rad), s = std::sin(keypoint.angle_rad);
    const auto u = static_cast<int>(std::lround(keypoint.x));
    const auto v = static_cast<int>(std::lround(keypoint.y));
    const auto value = [&](float x, float y) {
        return image.row(
            v + static_cast<int>(std::lround(s * x + c * y))
        )[u + static_cast<int>(std::lround(c * x - s * y))];
    };
    for (std::size_t i = 0; i < pattern_.size(); ++i) {
        const Pair& pair = pattern_[i];
        const bool less = value(pair.ax, pair.ay) < value(pair.bx, pair.by);
        auto& word = descriptor[i / 64];
        word = (word & ~(1ULL << (i % 64))) | (static_cast<std::uint64_t>(less) << (i % 64));
    }
}

}  // namespace kinectlab
