#pragma once

#include <span>

#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/analysis/swing_model.hpp"

namespace kinectlab {

/// The samples [begin, end) of a free swing, as far as it has been followed.
struct FreeSwing {
    std::size_t begin = 0;
    std::size_t end = 0;
    bool begin_found =
        false;  ///< it does not go on before `begin`: held, moved by hand, or no samples
    bool end_found = false;
};

/// How far from the expected path a free swing may be: within either.
struct PathTolerance {
    double sigma = 6.0;  ///< of a sample's noise
    double metres = 0.01;
};

/// Follows the parameters' motion (time 0 at sample `known.begin`) to both sides, each by at most
/// the time already known, a quarter of a period at once. Where three quarter periods in a row lie
/// off the path the swing was not free; half a period is left out there, because the bob may have
/// been held in the last quarter period that still looked right.
[[nodiscard]] FreeSwing grow_free_swing(
    std::span<const PositionSample> samples,
    FreeSwing known,
    const SwingParameters& parameters,
    double period,
    const PathTolerance& tolerance
);

}  // namespace kinectlab
