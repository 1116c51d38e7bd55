#include "pipeline/features/grey_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr float kReach_sigmas = 3.0F;
constexpr int kMostReach = 24;
constexpr int kTile = 256;  // columns; as many rows of them as a blur reads fit the nearest cache

KINECTLAB_HOT_LOOP void grey_row(
    const std::uint8_t* __restrict rgb, int count, float* __restrict out
) {
    for (int i = 0; i < count; ++i)
        out[i] = 0.299F * static_cast<float>(rgb[3 * i]) +
                 0.587F * static_cast<float>(rgb[3 * i + 1]) +
                 0.114F * static_cast<float>(rgb[3 * i + 2]);
}

/// Eight pixels at once, wherever they lie.
typedef float Lanes __attribute__((vector_size(32), aligned(4), may_alias));
constexpr int kLanes = 8;
constexpr int kTogether = 4;  // sums that stay in registers
constexpr int kBlock = kTogether * kLanes;

/// out = k0·middle + Σ k·(one side + other side), over whole rows or shifted ones. The sums of a
/// block stay in registers: written out for each weight, storing them took most of the time.
KINECTLAB_HOT_LOOP void weigh(
    const float* const* __restrict before,
    const float* const* __restrict after,
    const float* __restrict middle,
    const float* __restrict kernel,
    int reach,
    int count,
    float* __restrict out
) {
    if (count < kBlock) {
        for (int i = 0; i < count; ++i) {
            float sum = kernel[0] * middle[i];
            for (int k = 1; k <= reach; ++k)
                sum += kernel[k] * (before[k][i] + after[k][i]);
            out[i] = sum;
        }
        return;
    }
    for (int start = 0; start < count; start += kBlock) {
        const int at = std::min(start, count - kBlock);  // the last block repeats some pixels
        const Lanes* m = reinterpret_cast<const Lanes*>(middle + at);
        Lanes s0 = kernel[0] * m[0], s1 = kernel[0] * m[1], s2 = kernel[0] * m[2],
              s3 = kernel[0] * m[3];
        for (int k = 1; k <= reach; ++k) {
            const float weight = kernel[k];
            const Lanes* a = reinterpret_cast<const Lanes*>(before[k] + at);
            const Lanes* b = reinterpret_cast<const Lanes*>(after[k] + at);
            s0 += weight * (a[0] + b[0]);
            s1 += weight * (a[1] + b[1]);
            s2 += weight * (a[2] + b[2]);
            s3 += weight * (a[3] + b[3]);
        }
        Lanes* sums = reinterpret_cast<Lanes*>(out + at);
        sums[0] = s0, sums[1] = s1, sums[2] = s2, sums[3] = s3;
    }
}

KINECTLAB_HOT_LOOP void double_row(
    const float* __restrict a, const float* __restrict b, int width, float* __restrict out
) {
    for (int u = 0; u + 1 < width; ++u) {
        const float here = 0.5F * (a[u] + b[u]), next = 0.5F * (a[u + 1] + b[u + 1]);
        out[2 * u] = here;
        out[2 * u + 1] = 0.5F * (here + next);
    }
    out[2 * width - 2] = out[2 * width - 1] = 0.5F * (a[width - 1] + b[width - 1]);
}

/// Value half-way between the third and fourth of six, by the polynomial through them.
constexpr std::array kMidpoint = {150.0F / 256.0F, -25.0F / 256.0F, 3.0F / 256.0F};
constexpr int kMidpointReach = 3;

KINECTLAB_HOT_LOOP void between_rows(
    const std::array<const float*, 6>& rows, int count, float* __restrict out
) {
    const float *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3], *e = rows[4], *f = rows[5];
    for (int i = 0; i < count; ++i)
        out[i] = kMidpoint[0] * (c[i] + d[i]) + kMidpoint[1] * (b[i] + e[i]) +
                 kMidpoint[2] * (a[i] + f[i]);
}

/// `from` has kMidpointReach pixels more on either side.
KINECTLAB_HOT_LOOP void spread_row(const float* __restrict from, int count, float* __restrict out) {
    for (int i = 0; i < count; ++i) {
        out[2 * i] = from[i];
        out[2 * i + 1] = kMidpoint[0] * (from[i] + from[i + 1]) +
                         kMidpoint[1] * (from[i - 1] + from[i + 2]) +
                         kMidpoint[2] * (from[i - 2] + from[i + 3]);
    }
}

}  // namespace

void grey_of(
    std::span<const std::uint8_t> rgb, int width, const ImageRegion& region, GreyImage& grey
) {
    grey.resize(region.right - region.left, region.bottom - region.top);
    for (int v = 0; v < grey.height; ++v) {
        const auto first = static_cast<std::ptrdiff_t>((region.top + v) * width + region.left);
        grey_row(rgb.data() + 3 * first, grey.width, grey.row(v));
    }
}

void blur(const GreyImage& from, float sigma, GreyImage& to, std::vector<float>& scratch) {
    const int reach = std::min(kMostReach, static_cast<int>(std::ceil(kReach_sigmas * sigma)));
    std::array<float, kMostReach + 1> kernel{};
    float total = 0.0F;
    for (int k = 0; k <= reach; ++k) {
        const float off = static_cast<float>(k) / sigma;
        kernel[static_cast<std::size_t>(k)] = std::exp(-0.5F * off * off);
        total += (k == 0 ? 1.0F : 2.0F) * kernel[static_cast<std::size_t>(k)];
    }
    for (auto& weight : kernel)
        weight /= total;

    to.resize(from.width, from.height);
    scratch.resize(kTile + 2 * kMostReach);
    float* padded = scratch.data() + kMostReach;  // a row of the tile, blurred downwards
    std::array<const float*, kMostReach + 1> before{}, after{};
    for (int left = 0; left < from.width; left += kTile) {
        const int right = std::min(from.width, left + kTile);
        const int first = std::max(0, left - reach), end = std::min(from.width, right + reach);
        for (int v = 0; v < from.height; ++v) {
            for (int k = 0; k <= reach; ++k) {
                const auto i = static_cast<std::size_t>(k);
                before[i] = from.row(std::max(0, v - k)) + first;
                after[i] = from.row(std::min(from.height - 1, v + k)) + first;
            }
            weigh(
                before.data(),
                after.data(),
                from.row(v) + first,
                kernel.data(),
                reach,
                end - first,
                padded + (first - left)
            );
            std::fill(padded - reach, padded + (first - left), padded[first - left]);
            std::fill(
                padded + (end - left), padded + (right - left) + reach, padded[end - left - 1]
            );
            for (int k = 0; k <= reach; ++k) {
                const auto i = static_cast<std::size_t>(k);
                before[i] = padded - k;
                after[i] = padded + k;
            }
            weigh(
                before.data(),
                after.data(),
                padded,
                kernel.data(),
                reach,
                right - left,
                to.row(v) + left
            );
        }
    }
}

void doubled(const GreyImage& from, GreyImage& to) {
    to.resize(2 * from.width, 2 * from.height);
    for (int v = 0; v < from.height; ++v) {
        const float* below = from.row(std::min(from.height - 1, v + 1));
        double_row(from.row(v), from.row(v), from.width, to.row(2 * v));
        double_row(from.row(v), below, from.width, to.row(2 * v + 1));
    }
}

void halved(const GreyImage& from, GreyImage& to) {
    to.resize(std::max(1, from.width / 2), std::max(1, from.height / 2));
    for (int v = 0; v < to.height; ++v) {
        const float* row = from.row(2 * v);
        float* out = to.row(v);
        for (int u = 0; u < to.width; ++u)
            out[u] = row[2 * u];
    }
}

void unhalved(
    const GreyImage& from, int width, int height, GreyImage& to, std::vector<float>& scratch
) {
    to.resize(width, height);
    const int needed = (width + 1) / 2;
    scratch.resize(static_cast<std::size_t>(needed + 2 * kMidpointReach + width + 1));
    float* row = scratch.data() + kMidpointReach;
    float* spread = row + needed + kMidpointReach;
    const int count = std::min(needed, from.width);
    for (int v = 0; v < height; ++v) {
        const auto source = [&](int above) {
            return from.row(std::clamp(v / 2 + above, 0, from.height - 1));
        };
        if (v % 2 == 0)
            std::copy_n(source(0), count, row);
        else
            between_rows(
                {source(-2), source(-1), source(0), source(1), source(2), source(3)}, count, row
            );
        std::fill(row - kMidpointReach, row, row[0]);
        std::fill(row + count, row + needed + kMidpointReach, row[count - 1]);
        spread_row(row, needed, spread);
        std::copy_n(spread, width, to.row(v));
    }
}

}  // namespace kinectlab
