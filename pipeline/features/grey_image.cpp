#include "pipeline/features/grey_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr float kReach_sigmas = 3.5F;
constexpr int kMostReach = 24;

KINECTLAB_HOT_LOOP void grey_row(
    const std::uint8_t* __restrict rgb, int count, float* __restrict out
) {
    for (int i = 0; i < count; ++i)
        out[i] = 0.299F * static_cast<float>(rgb[3 * i]) +
                 0.587F * static_cast<float>(rgb[3 * i + 1]) +
                 0.114F * static_cast<float>(rgb[3 * i + 2]);
}

/// out = k0·middle + Σ k·(one side + other side), over whole rows or shifted ones.
KINECTLAB_HOT_LOOP void weigh(
    const float* const* __restrict before,
    const float* const* __restrict after,
    const float* __restrict middle,
    const float* __restrict kernel,
    int reach,
    int count,
    float* __restrict out
) {
    constexpr int kBlock = 64;  // stays in registers and the nearest cache
    for (int start = 0; start < count; start += kBlock) {
        const int end = std::min(count, start + kBlock);
        for (int i = start; i < end; ++i)
            out[i] = kernel[0] * middle[i];
        for (int k = 1; k <= reach; ++k) {
            const float weight = kernel[k];
            const float* __restrict a = before[k];
            const float* __restrict b = after[k];
            for (int i = start; i < end; ++i)
                out[i] += weight * (a[i] + b[i]);
        }
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
    scratch.resize(static_cast<std::size_t>(from.width + 2 * kMostReach));
    float* padded = scratch.data() + kMostReach;
    std::array<const float*, kMostReach + 1> before{}, after{};
    for (int v = 0; v < from.height; ++v) {
        for (int k = 0; k <= reach; ++k) {
            const auto i = static_cast<std::size_t>(k);
            before[i] = from.row(std::max(0, v - k));
            after[i] = from.row(std::min(from.height - 1, v + k));
        }
        weigh(before.data(), after.data(), from.row(v), kernel.data(), reach, from.width, padded);
        std::fill(padded - reach, padded, padded[0]);
        std::fill(padded + from.width, padded + from.width + reach, padded[from.width - 1]);
        for (int k = 0; k <= reach; ++k) {
            const auto i = static_cast<std::size_t>(k);
            before[i] = padded - k;
            after[i] = padded + k;
        }
        weigh(before.data(), after.data(), padded, kernel.data(), reach, from.width, to.row(v));
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

}  // namespace kinectlab
