#pragma once

#include "pipeline/preprocess/moving_least_squares.hpp"

namespace kinectlab {

/// An error that names the first field that is not a positive number.
[[nodiscard]] Result<void> check(const MovingLeastSquaresSettings& settings);

}  // namespace kinectlab
