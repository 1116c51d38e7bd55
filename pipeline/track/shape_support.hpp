#pragma once

#include <cstdint>
#include <span>

#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape.hpp"

namespace kinectlab {

/// When a point holds for a shape (the paper's Table I, acceptance): it lies within ε of the
/// surface and its normal within α of the surface's.
struct Tolerance {
    double sigmas = 3.0;        ///< ε in standard deviations of a reading, along the normal
    double least_m = 0.0015;    ///< ε is never less: no real surface is its equation
    double of_size = 0.0;       ///< ε grows by this part of a radius: what a rough shape is off
    double cos_normal = 0.906;  ///< cos α; 25°
};

/// How many of the points [begin, end) hold. The range begins at a multiple of
/// SurfacePoints::kLanes; one that is no multiple long is counted up to the next.
[[nodiscard]] int count_support(
    const Shape& shape,
    const SurfacePoints& points,
    std::size_t begin,
    std::size_t end,
    const Tolerance& tolerance
);

/// Writes 1 for each point that holds and 0 for the others; `holds` has the padded size.
void mark_support(
    const Shape& shape,
    const SurfacePoints& points,
    const Tolerance& tolerance,
    std::span<std::uint8_t> holds
);

/// Between which numbers of all `size` points the support lies, judged from `found` of a random
/// subset of `seen`: one standard deviation of the hypergeometric distribution to either side
/// (Schnabel et al. 2007, 4.5.1).
struct SupportBounds {
    double low = 0.0, middle = 0.0, high = 0.0;
};
[[nodiscard]] SupportBounds extrapolate(int found, std::size_t seen, std::size_t size);

}  // namespace kinectlab
