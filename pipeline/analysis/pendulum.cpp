#include "pipeline/analysis/pendulum.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/analysis/swing_fit.hpp"
#include "pipeline/analysis/swing_guess.hpp"
#include "pipeline/analysis/swing_length.hpp"
#include "pipeline/analysis/swing_measurements.hpp"
#include "pipeline/analysis/swing_warnings.hpp"

namespace kinectlab {
namespace {

constexpr double kStandardGravity = 9.80665;  // m/s²

Result<void> check(const PendulumSettings& s) {
    const auto in_range =
        [](const char* field, double value, double low, double high, const char* unit
        ) -> Result<void> {
        if (value >= low && value <= high) return {};
        return fail(
            ErrorCode::invalid_argument,
            field,
            fmt::format("is {}", value),
            fmt::format("give a number from {} to {}{}", low, high, unit)
        );
    };
    if (auto ok = in_range("length_m", s.length_m, 0.05, 100.0, " m"); !ok) return ok;
    if (auto ok = in_range("length_u_m", s.length_u_m, 0.0, 0.1 * s.length_m, " m"); !ok) return ok;
    if (auto ok = in_range("bob_radius_m", s.bob_radius_m, 0.0, s.length_m, " m"); !ok) return ok;
    if (auto ok = in_range("latitude_deg", s.latitude_deg, -90.0, 90.0, "°"); !ok) return ok;
    if (auto ok = in_range("depth_scale_u", s.depth_scale_u, 0.0, 0.2, ""); !ok) return ok;
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
    if (what.message != kAnotherMotion || !settings.on_earth) return what;
    constexpr double kFewest = 3.0;
    const double period = 2.0 * std::numbers::pi * std::sqrt(settings.length_m / kStandardGravity);
    const double moved = longest_motion_s(samples, period);
    if (moved >= kFewest * period) return what;
    return {
        ErrorCode::bad_data,
        "samples",
        fmt::format(
            "the bob moves for {:.1f} s in one go, {:.1f} periods of a pendulum of {} m: too short",
            moved,
            moved / period,
            settings.length_m
        ),
        "record at least three periods of free swing, ten or more for a good result; check "
        "length_m"};
}

}  // namespace

Result<PendulumResult> analyse_pendulum(
    const Trajectory& trajectory, const PendulumSettings& settings
) {
    if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
    const auto samples = collect_position_samples(trajectory);
    if (!samples) return tl::unexpected(samples.error());
    auto guess = guess_swing(*samples, settings.length_m);
    if (!guess) return tl::unexpected(guess.error());
    guess->parameters.turning = earth_turning(settings.latitude_deg);
    const auto fit = fit_swing(*samples, *guess, swing_priors(settings));
    if (!fit) return tl::unexpected(blame_length(fit.error(), *samples, settings));

    if (auto ok = check_sides(*samples, *fit, guess->period); !ok)
        return tl::unexpected(ok.error());

    PendulumResult result;
    const double duration = (*samples)[fit->end - 1].t - (*samples)[fit->begin].t;
    result.measurements = swing_measurements(*fit, settings, duration);
    result.fit = for_plots(trajectory, *samples, *fit);
    result.warnings = swing_warnings(*samples, *fit, result.measurements, settings);
    return result;
}

}  // namespace kinectlab
