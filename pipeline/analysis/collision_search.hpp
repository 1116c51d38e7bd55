#pragma once

#include <array>
#include <span>

#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/core/error.hpp"

namespace kinectlab {

/// Samples from `begin` up to and without `end`.
struct SampleRange {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// An impact of two balls, roughly.
struct Impact {
    double t = 0.0;                       ///< s, to about a frame
    std::array<SampleRange, 2> moving{};  ///< of each ball, where it moves as it does at the impact
};

/// Looks for the moment at which both paths bend at once and in opposite directions, then for how
/// long before and after it both go on uniformly: hands and cushions are left out. Times of both
/// balls count from one moment. `window_s` is the longest stretch that is used on each side.
/// Errors (bad_data): no such moment, fewer than five samples of a ball on one side of it.
[[nodiscard]] Result<Impact> find_impact(
    std::span<const PositionSample> a, std::span<const PositionSample> b, double window_s
);

}  // namespace kinectlab
