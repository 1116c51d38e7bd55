#include "pipeline/preprocess/depth_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace kinectlab {
namespace {

constexpr int kBins = 1024;            // one step each: everything beyond 0.34 m
constexpr int kHalfWindow = 3;         // a flat wall's readings spread over these bins
constexpr double kWallShare = 0.10;    // of the readings at least, in the window
constexpr double kBehindShare = 0.05;  // of the readings at most, behind the wall
constexpr double kFootShare = 0.05;    // of the peak's height: there the peak ends
constexpr int kMaxReach = 12;          // steps from the peak to its near foot

using Histogram = std::array<int, kBins>;

Histogram histogram_of(std::span<const float> disparity) {
    Histogram bins{};
    for (const float s : disparity)
        if (s > 0.0F && s < static_cast<float>(kBins)) ++bins[static_cast<std::size_t>(s)];
    return bins;
}

int window_sum(const Histogram& bins, int centre) {
    const int first = std::max(0, centre - kHalfWindow);
    const int last = std::min(kBins - 1, centre + kHalfWindow);
    return std::accumulate(bins.begin() + first, bins.begin() + last + 1, 0);
}

/// The farthest bin around which a tenth of all readings lie, moved on to the top of its peak.
std::optional<int> farthest_peak(const Histogram& bins, double total) {
    for (int bin = 0; bin < kBins; ++bin) {
        if (window_sum(bins, bin) < kWallShare * total) continue;
        while (bin + 1 < kBins && window_sum(bins, bin + 1) > window_sum(bins, bin))
            ++bin;
        return bin;
    }
    return std::nullopt;
}

}  // namespace

std::optional<double> wall_cut_steps(std::span<const float> disparity) {
    const Histogram bins = histogram_of(disparity);
    const double total = std::accumulate(bins.begin(), bins.end(), 0.0);
    const auto peak = farthest_peak(bins, total);
    if (total == 0.0 || !peak) return std::nullopt;

    const int far_side = std::max(0, *peak - 2 * kHalfWindow);
    const double behind = std::accumulate(bins.begin(), bins.begin() + far_side, 0.0);
    if (behind > kBehindShare * total) return std::nullopt;

    const double height = window_sum(bins, *peak) / (2.0 * kHalfWindow + 1.0);
    for (int bin = *peak; bin < std::min(kBins, *peak + kMaxReach); ++bin)
        if (bins[static_cast<std::size_t>(bin)] < kFootShare * height) return bin + 1.0;
    return std::nullopt;
}

}  // namespace kinectlab
