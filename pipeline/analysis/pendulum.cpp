#include "pipeline/analysis/pendulum.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/analysis/swing_arc.hpp"
#include "pipeline/analysis/swing_fit.hpp"
#include "pipeline/analysis/swing_guess.hpp"
#include "pipeline/analysis/swing_length.hpp"
#include "pipeline/analysis/swing_measurements.hpp"
#include "pipeline/analysis/swing_notes.hpp"
#include "pipeline/analysis/swing_warnings.hpp"

namespace kinectlab {
namespace {

constexpr double kStandardGravity = 9.80665;  // m/s²

Result<void> in_range(
    const char* field, std::optional<double> value, double low, double high, const char* unit
) {
    if (!value || (*value >= low && *value <= high)) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        fmt::format("is {}", *value),
        fmt::format("give a number from {} to {}{}", low, high, unit)
    );
}

Result<void> check(const PendulumSettings& s) {
    const double length = s.length_m.value_or(100.0);
    if (auto ok = in_range("length_m", s.length_m, 0.05, 100.0, " m"); !ok) return ok;
    if (auto ok = in_range("length_u_m", s.length_u_m, 0.0, 0.1 * length, " m"); !ok) return ok;
    if (auto ok = in_range("bob_radius_m", s.body.bob_radius_m, 0.0, length, " m"); !ok) return ok;
    if (auto ok = in_range("latitude_deg", s.latitude_deg, -90.0, 90.0, "°"); !ok) return ok;
    if (auto ok = in_range("depth_scale_u", s.depth_scale_u, 0.0, 0.2, ""); !ok) return ok;
    const double bob = s.body.bob_density_kg_m3.value_or(0.0);
    if (bob > 0.0 && s.body.air_density_kg_m3 >= 0.5 * bob)
        return in_range("air_density_kg_m3", s.body.air_density_kg_m3, 0.0, 0.5 * bob, " kg/m³");
    return in_range("clock_u", s.clock_u, 0.0, 0.2, "");
}

// A swing that is seen on one side only looks like one of half the period with every other one
// hidden.
Result<void> check_sides(
    const std::vector<PositionSample>& samples, const SwingFit& fit, double period
) {
    std::size_t hidden = 0;
    for (std::size_t i = fit.begin + 1; i < fit.end; ++i)
        if (const double gap = (samples[i].t - samples[i - 1].t) / period; gap > 0.5 && gap < 1.5)
            ++hidden;
    const double periods = (samples[fit.end - 1].t - samples[fit.begin].t) / period;
    if (static_cast<double>(hidden) <= periods / 3.0) return {};
    return fail(
        ErrorCode::bad_data,
        "samples",
        "the bob was out of sight in the same part of every swing, so its period is not sure",
        "see that nothing hides the bob, and that it does not hang in the way when the scene is "
        "learned"
    );
}

ObjectFit for_plots(
    const Trajectory& trajectory, const std::vector<PositionSample>& samples, const SwingFit& fit
) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    ObjectFit plot;
    plot.object = trajectory.object;
    const std::size_t first = samples[fit.begin].index;
    const std::size_t last = samples[fit.end - 1].index;
    SwingPath path(fit.parameters);
    for (std::size_t i = 0; i < trajectory.samples.size(); ++i) {
        const MotionSample& sample = trajectory.samples[i];
        Eigen::Vector3d measured = Eigen::Vector3d::Constant(kNan);
        Eigen::Vector3d fitted = Eigen::Vector3d::Constant(kNan);
        if (sample.status == TrackStatus::tracked) measured = sample.p_lab;
        if (i >= first && i <= last) {
            path.go_to(to_seconds(sample.t - trajectory.samples[first].t));
            fitted = path.position();
        }
        plot.t.push_back(sample.t);
        plot.p_lab.push_back(measured);
        plot.fit_lab.push_back(fitted);
        plot.residual.emplace_back(measured - fitted);
    }
    for (const bool used : fit.used)
        ++(used ? plot.used : plot.outliers);
    plot.reduced_chi2 = fit.reduced_chi2;
    return plot;
}

/// A swing that is too short looks like another motion: tell how short it is
/// instead. `what` where it was long enough, or failed for another reason.
Error blame_length(
    Error what, const std::vector<PositionSample>& samples, const PendulumSettings& settings
) {
    if (what.message != kAnotherMotion || !settings.on_earth || !settings.length_m) return what;
    constexpr double kFewest = 3.0;
    const double period = 2.0 * std::numbers::pi * std::sqrt(*settings.length_m / kStandardGravity);
    const double moved = longest_motion_s(samples, period);
    if (moved >= kFewest * period) return what;
    return {
        ErrorCode::bad_data,
        "samples",
        fmt::format(
            "the bob moves for {:.1f} s in one go, {:.1f} periods of a pendulum of {} m: too short",
            moved,
            moved / period,
            *settings.length_m
        ),
        "record at least three periods of free swing, ten or more for a good result; check "
        "length_m"};
}

}  // namespace

Result<FollowedSwing> follow_swing(const Trajectory& trajectory, const PendulumSettings& settings) {
    if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
    FollowedSwing swing;
    swing.settings = settings;
    swing.trajectory = trajectory;
    auto samples = collect_position_samples(trajectory);
    if (!samples) return tl::unexpected(samples.error());
    if (!settings.metric && arc_curvature(*samples).shows_upside_down()) {
        for (auto& sample : swing.trajectory.samples)
            sample.p_lab.z() = -sample.p_lab.z();
        samples = collect_position_samples(swing.trajectory);
        swing.notes.emplace_back(
            "The ends of the arc have the smaller y: rows of pixels were counted downwards, and "
            "are "
            "turned over here."
        );
    }
    swing.samples = std::move(*samples);
    swing.settings.flat = is_flat(swing.samples);
    const auto length = settings.metric ? settings.length_m : std::nullopt;
    auto guess = guess_swing(swing.samples, length, settings.metric && settings.on_earth);
    if (!guess) return tl::unexpected(guess.error());
    const bool turns = !swing.settings.flat && !settings.turning_free;
    guess->parameters.turning = turns ? earth_turning(settings.latitude_deg) : 0.0;
    auto fit = fit_swing(
        swing.samples,
        *guess,
        swing_priors(settings, guess->parameters.radius),
        settings.turning_free && !swing.settings.flat
    );
    if (!fit) return tl::unexpected(blame_length(fit.error(), swing.samples, settings));
    swing.fit = std::move(*fit);
    if (auto ok = check_sides(swing.samples, swing.fit, guess->period); !ok)
        return tl::unexpected(ok.error());
    swing.duration_s = swing.samples[swing.fit.end - 1].t - swing.samples[swing.fit.begin].t;
    swing.object = for_plots(swing.trajectory, swing.samples, swing.fit);
    return swing;
}

PendulumResult pendulum_result(const FollowedSwing& swing) {
    PendulumResult result;
    result.measurements = swing_measurements(swing.fit, swing.settings, swing.duration_s);
    result.fit = swing.object;
    result.warnings = swing_warnings(swing.samples, swing.fit, result.measurements, swing.settings);
    result.notes = swing.notes;
    for (auto& note : swing_notes(swing.fit, result.measurements, swing.settings))
        result.notes.push_back(std::move(note));
    return result;
}

Result<PendulumResult> analyse_pendulum(
    const Trajectory& trajectory, const PendulumSettings& settings
) {
    return follow_swing(trajectory, settings).map(pendulum_result);
}

}  // namespace kinectlab
