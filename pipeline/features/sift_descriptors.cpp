#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/features/sift.hpp"

namespace kinectlab {
namespace {

constexpr int kTurns = 36;              // bins of the dominant gradient's direction (Lowe 2004, 5)
constexpr float kTurnSigmas = 1.5F;     // of its window, in the keypoint's σ
constexpr float kSecondTurn = 0.8F;     // of the highest bin: another keypoint
constexpr int kCells = 4, kAngles = 8;  // of the descriptor (6.2)
constexpr float kCell_sigmas = 3.0F;
constexpr float kMostOfOne = 0.2F;  // no number outweighs all others (6.1)
// A layer blurred by 2 px says nothing new in every second pixel; Lowe takes 16 x 16 samples (6.1).
constexpr float kCoarseCell = 6.0F;  // px
constexpr float kPi = std::numbers::pi_v<float>;

/// atan2 in turns of 2π, 0 to 1, to 2e-5: Abramowitz & Stegun 4.4.47, without a branch.
inline float turns_of(float y, float x) {
    const float ax = std::abs(x), ay = std::abs(y);
    const float high = std::max(ax, ay) + 1e-12F, low = std::min(ax, ay);
    const float a = low / high, a2 = a * a;
    const float octant =
        a * (0.9998660F +
             a2 * (-0.3302995F + a2 * (0.1801410F + a2 * (-0.0851330F + a2 * 0.0208351F))));
    float angle = ay > ax ? 0.5F * kPi - octant : octant;
    angle = x < 0.0F ? kPi - angle : angle;
    angle = y < 0.0F ? 2.0F * kPi - angle : angle;
    return angle * (0.5F / kPi);
}

/// One row of gradients: direction in turns and length.
KINECTLAB_HOT_LOOP void gradients_of_row(
    const float* __restrict above,
    const float* __restrict own,
    const float* __restrict below,
    int count,
    float* __restrict turns,
    float* __restrict length
) {
    for (int i = 0; i < count; ++i) {
        const float dx = own[i + 1] - own[i - 1], dy = below[i] - above[i];
        turns[i] = turns_of(dy, dx);
        length[i] = std::sqrt(dx * dx + dy * dy);
    }
}

}  // namespace

/// Adds the keypoint again, once for each direction that stands out.
void Sift::orient(const Keypoint2d& keypoint) {
    const GreyImage& image = layer(keypoint.octave, keypoint.layer);
    const float pixel =
        std::exp2(static_cast<float>(keypoint.octave) - (settings_.doubled ? 1.0F : 0.0F));
    const float sigma = kTurnSigmas * keypoint.scale_px / pixel;
    const auto radius = static_cast<int>(std::lround(3.0F * sigma));
    const auto x = static_cast<int>(std::lround(keypoint.x));
    const auto y = static_cast<int>(std::lround(keypoint.y));
    const int left = std::max(1, x - radius), right = std::min(image.width - 2, x + radius);
    const int top = std::max(1, y - radius), bottom = std::min(image.height - 2, y + radius);
    if (left > right) return;
    const auto count = static_cast<std::size_t>(right - left + 1);
    for (auto& field : window_)
        field.resize(std::max(field.size(), count));
    std::array<float, kTurns> histogram{};
    const float fall = -0.5F / (sigma * sigma);
    for (int u = left; u <= right; ++u)
        window_[2][static_cast<std::size_t>(u - left)] =
            std::exp(fall * static_cast<float>((u - x) * (u - x)));
    for (int v = top; v <= bottom; ++v) {
        gradients_of_row(
            image.row(v - 1) + left,
            image.row(v) + left,
            image.row(v + 1) + left,
            static_cast<int>(count),
            window_[0].data(),
            window_[1].data()
        );
        const float down = std::exp(fall * static_cast<float>((v - y) * (v - y)));
        for (std::size_t i = 0; i < count; ++i) {
            const auto bin = static_cast<std::size_t>(window_[0][i] * kTurns + 0.5F);
            histogram[bin % kTurns] += down * window_[2][i] * window_[1][i];
        }
    }
    std::array<float, kTurns> smooth{};
    const auto at = [&](std::size_t i, int off) {
        return histogram[(i + static_cast<std::size_t>(kTurns + off)) % kTurns];
    };
    for (std::size_t i = 0; i < kTurns; ++i)
        smooth[i] =
            0.375F * at(i, 0) + 0.25F * (at(i, -1) + at(i, 1)) + 0.0625F * (at(i, -2) + at(i, 2));
    const float highest = *std::max_element(smooth.begin(), smooth.end());
    for (std::size_t i = 0; i < kTurns; ++i) {
        const float before = smooth[(i + kTurns - 1) % kTurns], here = smooth[i],
                    after = smooth[(i + 1) % kTurns];
        if (here < kSecondTurn * highest || here <= before || here <= after) continue;
        Keypoint2d turned = keypoint;
        const float shift = 0.5F * (before - after) / (before - 2.0F * here + after);
        turned.angle_rad = (static_cast<float>(i) + shift) * 2.0F * kPi / kTurns;
        keypoints_.push_back(turned);
    }
}

void Sift::describe(const Keypoint2d& keypoint, Descriptor& descriptor) {
    const GreyImage& image = layer(keypoint.octave, keypoint.layer);
    const float pixel =
        std::exp2(static_cast<float>(keypoint.octave) - (settings_.doubled ? 1.0F : 0.0F));
    const float cell = kCell_sigmas * keypoint.scale_px / pixel;
    const auto radius =
        static_cast<int>(std::lround(cell * std::numbers::sqrt2_v<float> * (kCells + 1) * 0.5F));
    const float c = std::cos(keypoint.angle_rad) / cell, s = std::sin(keypoint.angle_rad) / cell;
    const float own_turns = keypoint.angle_rad * (0.5F / kPi);
    const auto middle_x = static_cast<int>(std::lround(keypoint.x));
    const auto middle_y = static_cast<int>(std::lround(keypoint.y));
    const float fall = -1.0F / (0.5F * kCells * kCells * cell * cell);
    for (auto& field : window_)
        field.resize(std::max(field.size(), static_cast<std::size_t>(2 * radius + 1)));

    // The fall of the weight is a product of one along the rows and one across.
    for (int off = -radius; off <= radius; ++off) {
        const auto i = static_cast<std::size_t>(off + radius);
        const float dx = static_cast<float>(middle_x + off) - keypoint.x;
        const float dy = static_cast<float>(middle_y + off) - keypoint.y;
        window_[2][i] = std::exp(fall * dx * dx);
        window_[3][i] = std::exp(fall * dy * dy);
    }

    // Two cells more on each side and an angle more at the end take what falls outside.
    constexpr int kWide = kCells + 2, kLong = kAngles + 2;
    std::array<float, static_cast<std::size_t>(kWide * kWide * kLong)> histogram{};
    const int step = cell >= kCoarseCell ? 2 : 1;
    for (int v = std::max(1, middle_y - radius); v <= std::min(image.height - 2, middle_y + radius);
         v += step) {
        const float dy = static_cast<float>(v) - keypoint.y;
        // Where |rotated coordinates| < (kCells + 1)/2 along this row.
        constexpr float kHalf = 0.5F * (kCells + 1);
        float low = static_cast<float>(-radius), high = static_cast<float>(radius);
        const auto narrow = [&](float slope, float offset) {
            if (std::abs(slope) < 1e-6F) {
                if (std::abs(offset) >= kHalf) high = low - 1.0F;
                return;
            }
            const float a = (-kHalf - offset) / slope, b = (kHalf - offset) / slope;
            low = std::max(low, std::min(a, b));
            high = std::min(high, std::max(a, b));
        };
        narrow(c, s * dy);
        narrow(-s, c * dy);
        const float down = window_[3][static_cast<std::size_t>(v - middle_y + radius)];
        const int from =
            std::max({1, middle_x - radius, static_cast<int>(std::ceil(keypoint.x + low))});
        const int to = std::min(
            {image.width - 2, middle_x + radius, static_cast<int>(std::floor(keypoint.x + high))}
        );
        if (from > to) continue;
        const int count = to - from + 1;
        gradients_of_row(
            image.row(v - 1) + from,
            image.row(v) + from,
            image.row(v + 1) + from,
            count,
            window_[0].data(),
            window_[1].data()
        );
        for (int i = 0; i < count; i += step) {
            const float dx = static_cast<float>(from + i) - keypoint.x;
            const auto at = static_cast<std::size_t>(i);
            const float column = c * dx + s * dy + 0.5F * kCells + 0.5F;
            const float line = -s * dx + c * dy + 0.5F * kCells + 0.5F;
            float angle = window_[0][at] - own_turns;
            angle = (angle - std::floor(angle)) * kAngles;
            const float weight = window_[1][at] * down *
                                 window_[2][static_cast<std::size_t>(from + i - middle_x + radius)];
            const auto i0 = static_cast<int>(column), j0 = static_cast<int>(line),
                       k0 = static_cast<int>(angle);
            if (i0 < 0 || j0 < 0 || i0 > kWide - 2 || j0 > kWide - 2) continue;
            const float fi = column - static_cast<float>(i0), fj = line - static_cast<float>(j0),
                        fk = angle - static_cast<float>(k0);
            float* out = &histogram[static_cast<std::size_t>((j0 * kWide + i0) * kLong + k0)];
            const float w1 = weight * fj, w0 = weight - w1;
            const float w01 = w0 * fi, w00 = w0 - w01, w11 = w1 * fi, w10 = w1 - w11;
            out[0] += w00 * (1.0F - fk), out[1] += w00 * fk;
            out[kLong] += w01 * (1.0F - fk), out[kLong + 1] += w01 * fk;
            out += kWide * kLong;
            out[0] += w10 * (1.0F - fk), out[1] += w10 * fk;
            out[kLong] += w11 * (1.0F - fk), out[kLong + 1] += w11 * fk;
        }
    }
    std::size_t next = 0;
    for (int j = 1; j <= kCells; ++j)
        for (int i = 1; i <= kCells; ++i) {
            float* bins = &histogram[static_cast<std::size_t>((j * kWide + i) * kLong)];
            bins[0] += bins[kAngles];
            bins[1] += bins[kAngles + 1];
            for (int k = 0; k < kAngles; ++k)
                descriptor[next++] = bins[k];
        }
    for (int pass = 0; pass < 2; ++pass) {
        float squares = 0.0F;
        for (const float value : descriptor)
            squares += value * value;
        const float scale = squares > 0.0F ? 1.0F / std::sqrt(squares) : 0.0F;
        for (float& value : descriptor)
            value = pass == 0 ? std::min(kMostOfOne, value * scale) : value * scale;
    }
}

}  // namespace kinectlab
