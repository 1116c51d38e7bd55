#pragma once

#include <optional>
#include <vector>

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/pendulum_corrections.hpp"
#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/analysis/swing_fit.hpp"
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
    /// Pivot to the bob's centre; without it the arc itself tells.
    std::optional<double> length_m;
    double length_u_m = 0.0005;  ///< its standard uncertainty
    PendulumBody body;
    double latitude_deg = 45.0;   ///< of the rig, for the turning of the swing plane
    double depth_scale_u = 1e-3;  ///< relative
    double clock_u = 2e-5;        ///< relative
    double tilt_u_rad = 0.02;     ///< how well the lab frame is levelled, about each axis
    bool on_earth = true;         ///< false where a simulation took another g on purpose
    bool metric = true;           ///< false: a metre is a thousand pixels of unknown size
    bool turning_free = false;    ///< the plane's turning is fitted instead of the latitude's
    bool flat = false;            ///< seen in one plane; found out by follow_swing()
};

/// A swing that was found and fitted.
struct FollowedSwing {
    PendulumSettings settings;  ///< with what the positions themselves told
    Trajectory trajectory;      ///< the one that was fitted: pixels may stand on their head
    std::vector<PositionSample> samples;  ///< all tracked ones
    SwingFit fit;
    ObjectFit object;
    double duration_s = 0.0;  ///< of the free swing
    std::vector<std::string> notes;
};

/// Fits the equation of motion of a damped spherical pendulum on the turning Earth to all measured
/// positions at once. Only samples with status tracked count; gaps need no filling.
/// Errors (never a number): fewer than three periods, no motion, amplitude beyond 80°, NaN or
/// times that do not increase.
[[nodiscard]] Result<FollowedSwing> follow_swing(
    const Trajectory& trajectory, const PendulumSettings& settings
);

struct PendulumResult {
    /// g (m/s², if the length is known), period (s, as swung), small_angle_period (s), amplitude
    /// (rad, at the start), damping (1/s), and what else the fit knows.
    std::vector<Measurement> measurements;
    ObjectFit fit;
    std::vector<std::string> warnings;  ///< for a student: what makes this run less good
    std::vector<std::string> notes;     ///< what was assumed or estimated
};

/// What a followed swing came to.
[[nodiscard]] PendulumResult pendulum_result(const FollowedSwing& swing);

/// follow_swing, then pendulum_result.
[[nodiscard]] Result<PendulumResult> analyse_pendulum(
    const Trajectory& trajectory, const PendulumSettings& settings
);

}  // namespace kinectlab
