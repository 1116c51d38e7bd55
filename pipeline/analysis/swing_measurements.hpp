#pragma once

#include <string>
#include <vector>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/analysis/swing_fit.hpp"

namespace kinectlab {

/// The fit's numbers with their budgets: g, period, small_angle_period, amplitude, damping,
/// quality_factor and, where the orbit is narrow enough to show it, turning_rate.
/// `duration_s` is that of the free swing.
[[nodiscard]] std::vector<Measurement> swing_measurements(
    const SwingFit& fit, const PendulumSettings& settings, double duration_s
);

/// What the fit's priors are for these settings.
[[nodiscard]] SwingPriors swing_priors(const PendulumSettings& settings);

/// Vertical part of the Earth's turning at a latitude, rad/s.
[[nodiscard]] double earth_turning(double latitude_deg);

}  // namespace kinectlab
