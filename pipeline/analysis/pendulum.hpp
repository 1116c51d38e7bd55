#pragma once

#include <optional>
#include <vector>

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/measurement.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab {

constexpr double kLeastOnEarth = 9.76;  ///< m/s², g on high mountains near the equator
constexpr double kMostOnEarth = 9.84;   ///< m/s², at the poles' sea

/// Whether g (m/s²), known to `within`, can be that of a place on the Earth's ground.
[[nodiscard]] constexpr bool is_earthly(double g, double within = 0.0) {
    return g >= kLeastOnEarth - within && g <= kMostOnEarth + within;
}

struct PendulumSettings {
    double length_m = 1.0;        ///< pivot to the bob's centre
    double length_u_m = 0.0005;   ///< its standard uncertainty
    double bob_radius_m = 0.05;   ///< solid sphere that turns with the string; 0 = a point
    double latitude_deg = 45.0;   ///< of the rig, for the turning of the swing plane
    double depth_scale_u = 1e-3;  ///< relative
    double clock_u = 2e-5;        ///< relative
    bool on_earth = true;         ///< false where a simulation took another g on purpose
};

struct PendulumResult {
    /// g (m/s²), period (s, as swung), small_angle_period (s), amplitude (rad, at the start),
    /// damping (1/s), and what else the fit knows.
    std::vector<Measurement> measurements;
    ObjectFit fit;
    std::vector<std::string> warnings;  ///< for a student: what makes this run less good
};

/// Fits the equation of motion of a damped spherical pendulum on the turning Earth to all measured
/// positions at once. Only samples with status tracked count; gaps need no filling.
/// Errors (never a number): fewer than three periods, no motion, amplitude beyond 80°, NaN or
/// times that do not increase.
[[nodiscard]] Result<PendulumResult> analyse_pendulum(
    const Trajectory& trajectory, const PendulumSettings& settings
);

}  // namespace kinectlab
