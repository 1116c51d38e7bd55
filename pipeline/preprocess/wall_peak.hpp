#pragma once

#include <array>
#include <optional>
#include <span>

namespace kinectlab {

/// The histogram in which a wall across the view, or distances from a wall's plane, make a peak.
inline constexpr int kBins = 1024;          // one step each: everything beyond 0.34 m
inline constexpr int kHalfWindow = 3;       // a flat wall's readings spread over these bins
inline constexpr double kWallShare = 0.10;  // of the readings at least, in the window

using Histogram = std::array<int, kBins>;

/// Of readings in steps; bin 0, no reading, stays empty.
[[nodiscard]] Histogram histogram_of(std::span<const float> disparity);

/// The farthest bin around which a tenth of all readings lie, moved on to the top of its peak.
[[nodiscard]] std::optional<int> farthest_peak(const Histogram& bins, double total);

struct Peak {
    int top = 0;
    int foot = 0;  ///< first bin that is not cut away
};

/// The far wall's peak, if it ends on both sides and little lies behind it.
[[nodiscard]] std::optional<Peak> wall_peak(const Histogram& bins);

}  // namespace kinectlab
