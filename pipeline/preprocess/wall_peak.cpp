#include "pipeline/preprocess/wall_peak.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr double kBehindShare = 0.05;  // of the readings at most, behind the wall
constexpr double kFootShare = 0.01;    // of the peak's height: there the peak ends
constexpr int kMaxReach = 12;          // steps from the peak to where it ends

constexpr std::size_t kBatch = 1024;

/// The bins of readings; kBins for what lies outside.
KINECTLAB_HOT_LOOP void bins_of(const float* disparity, std::size_t n, std::uint16_t* bins) {
    for (std::size_t i = 0; i < n; ++i) {
        const float s = disparity[i];
        const float inside = s >= 0.0F && s < static_cast<float>(kBins) ? s : kBins;
        bins[i] = static_cast<std::uint16_t>(static_cast<int>(inside));
    }
}

int window_sum(const Histogram& bins, int centre) {
    const int first = std::max(0, centre - kHalfWindow);
    const int last = std::min(kBins - 1, centre + kHalfWindow);
    return std::accumulate(bins.begin() + first, bins.begin() + last + 1, 0);
}

}  // namespace

/// Four counters for each bin in turn: neighbours fall in the same bin, and one counter would wait
/// for itself.
Histogram histogram_of(std::span<const float> disparity) {
    std::array<std::array<int, kBins + 1>, 4> counts{};
    std::array<std::uint16_t, kBatch> bins;
    for (std::size_t first = 0; first < disparity.size(); first += kBatch) {
        const std::size_t n = std::min(kBatch, disparity.size() - first);
        bins_of(disparity.data() + first, n, bins.data());
        std::size_t i = 0;
        for (; i + 4 <= n; i += 4)
            for (std::size_t k = 0; k < 4; ++k)
                ++counts[k][bins[i + k]];
        for (; i < n; ++i)
            ++counts[0][bins[i]];
    }
    Histogram all{};
    for (std::size_t bin = 1; bin < kBins; ++bin)  // 0 is no reading
        all[bin] = counts[0][bin] + counts[1][bin] + counts[2][bin] + counts[3][bin];
    return all;
}

std::optional<int> farthest_peak(const Histogram& bins, double total) {
    for (int bin = 0; bin < kBins; ++bin) {
        if (window_sum(bins, bin) < kWallShare * total) continue;
        while (bin + 1 < kBins && window_sum(bins, bin + 1) > window_sum(bins, bin))
            ++bin;
        return bin;
    }
    return std::nullopt;
}

std::optional<Peak> wall_peak(const Histogram& bins) {
    const double total = std::accumulate(bins.begin(), bins.end(), 0.0);
    const auto centre = farthest_peak(bins, total);
    if (total == 0.0 || !centre) return std::nullopt;
    const auto first = bins.begin() + std::max(0, *centre - kHalfWindow);
    const auto last = bins.begin() + std::min(kBins - 1, *centre + kHalfWindow);
    const int top = static_cast<int>(std::max_element(first, last + 1) - bins.begin());

    const int far_side = std::max(0, top - 2 * kHalfWindow);
    const double behind = std::accumulate(bins.begin(), bins.begin() + far_side, 0.0);
    if (behind > kBehindShare * total) return std::nullopt;

    const double height = bins[static_cast<std::size_t>(top)];
    const auto ends = [&](int bin) {
        return bin < 0 || bin >= kBins || bins[static_cast<std::size_t>(bin)] < kFootShare * height;
    };
    int far = 1, near = 1;
    while (far < kMaxReach && !ends(top - far))
        ++far;
    while (near < kMaxReach && !ends(top + near))
        ++near;
    if (far == kMaxReach) return std::nullopt;
    // One bin more, because the top lies anywhere in its own.
    return Peak{top, top + std::min(near, far + 1) + 1};
}

}  // namespace kinectlab
