#pragma once

#include <string>
#include <vector>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/analysis/swing_fit.hpp"

namespace kinectlab {

/// What was assumed or estimated, and what that costs: the drag law and why, the length if it came
/// from the arc, what was not corrected for, pixels.
[[nodiscard]] std::vector<std::string> swing_notes(
    const SwingFit& fit,
    const std::vector<Measurement>& measurements,
    const PendulumSettings& settings
);

/// The sentence on the drag law.
[[nodiscard]] std::string drag_note(const SwingFit& fit);

}  // namespace kinectlab
