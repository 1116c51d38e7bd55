#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/analysis/swing_fit.hpp"

namespace kinectlab {

/// What makes a run less good, in sentences for a student. `samples` are all tracked ones.
[[nodiscard]] std::vector<std::string> swing_warnings(
    std::span<const PositionSample> samples,
    const SwingFit& fit,
    const std::vector<Measurement>& measurements,
    const PendulumSettings& settings
);

}  // namespace kinectlab
