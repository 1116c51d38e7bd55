#pragma once

#include <string>
#include <vector>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/analysis/swing_fit.hpp"

namespace kinectlab {

/// The fit's numbers with their budgets: g (if the length is given or the arc shows it), period,
/// small_angle_period, amplitude, damping and quadratic_damping (those that the chosen law has),
/// quality_factor and, where the orbit is narrow enough to show it, turning_rate.
/// `duration_s` is that of the free swing.
[[nodiscard]] std::vector<Measurement> swing_measurements(
    const SwingFit& fit, const PendulumSettings& settings, double duration_s
);

/// What the fit's priors are for these settings. Without a length in metres the arc's radius is
/// only known to be about `rough_radius_m`.
[[nodiscard]] SwingPriors swing_priors(const PendulumSettings& settings, double rough_radius_m);

/// Whether g can be given: a length, or an arc that shows its own to a tenth.
[[nodiscard]] bool shows_g(const SwingFit& fit, const PendulumSettings& settings);

/// The amplitude of a plane swing `t_s` after the parameters' time 0, rad: it falls as
/// -γθ - (4/3π) βω₀θ², from the work that drag does in a small swing (Nelson and Olsson 1986).
[[nodiscard]] double amplitude_after(const SwingParameters& parameters, double t_s);

/// Its root mean square over the time.
[[nodiscard]] double mean_amplitude(const SwingParameters& parameters, double duration_s);

/// Vertical part of the Earth's turning at a latitude, rad/s.
[[nodiscard]] double earth_turning(double latitude_deg);

constexpr double kSiderealDay = 86164.09;  ///< s

}  // namespace kinectlab
