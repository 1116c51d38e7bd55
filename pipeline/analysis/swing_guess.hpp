#pragma once

#include <optional>
#include <span>

#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/analysis/swing_model.hpp"

namespace kinectlab {

/// Three periods in which the bob surely swings freely, and roughly how.
struct SwingGuess {
    std::size_t begin = 0;  ///< samples [begin, end)
    std::size_t end = 0;
    double period = 0.0;         ///< s
    SwingParameters parameters;  ///< time 0 is that of sample `begin`
};

/// Finds the period by a least-squares spectrum of the velocities, which rest and gaps do not
/// mislead, and the three periods that look most like a sine. Without a length it starts from the
/// arc's, or from what its period would be on the Earth if positions are `metric`.
/// Errors (bad_data): no motion beyond noise, less than three periods, nothing like a swing, a bob
/// farther than sin 80° of the length from the middle.
[[nodiscard]] Result<SwingGuess> guess_swing(
    std::span<const PositionSample> samples, std::optional<double> length_m, bool metric = true
);

}  // namespace kinectlab
