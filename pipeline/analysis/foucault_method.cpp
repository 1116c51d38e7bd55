#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/foucault_plots.hpp"
#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"
#include "pipeline/analysis/pendulum_settings.hpp"
#include "pipeline/analysis/swing_budget.hpp"
#include "pipeline/analysis/swing_measurements.hpp"
#include "pipeline/analysis/swing_plots.hpp"

namespace kinectlab {
namespace {

using std::numbers::pi;

constexpr double kEarth = 2.0 * pi / kSiderealDay;  // rad/s
constexpr double kRound = 1e-3;                     // rad/s: no plane is seen in such an orbit

/// Half the orbit's width, m, at the parameters' time 0; above zero if it goes round against the
/// clock as seen from above. From energy and angular momentum, which an undamped orbit keeps:
/// 2 (E + w² cos θ) sin² θ = l² at the turning point nearest to the plumb line.
double half_width(const SwingParameters& p) {
    const double energy = 0.5 * p.v.squaredNorm() - p.omega0_sq * p.n.dot(p.down());
    const double l = -p.n.cross(p.v).dot(p.down());
    double low = 0.0;  // sin² θ
    double high = p.n.cross(p.down()).squaredNorm();
    for (int i = 0; i < 80; ++i) {
        const double s = (low + high) / 2.0;
        (2.0 * (energy + p.omega0_sq * std::sqrt(1.0 - s)) * s < l * l ? low : high) = s;
    }
    return std::copysign(p.radius * std::sqrt(low), l);
}

double half_length(const SwingParameters& p) {
    return p.radius * std::sin(turning_angle(p));
}

/// What the ellipse turns by itself, on average over the run, counted as the Earth's turning is:
/// with the clock above zero.
double airy_rate(const SwingParameters& p, double duration_s) {
    const double kept = std::pow(mean_amplitude(p, duration_s) / energy_angle(p), 2);
    return -3.0 / 8.0 * std::sqrt(p.omega0_sq) * half_length(p) * half_width(p) /
           (p.radius * p.radius) * kept;
}

void add_turning(const FollowedSwing& swing, AnalysisOutcome& outcome) {
    const SwingBudgets budgets(swing.fit, swing.settings);
    const SwingParameters& p = swing.fit.parameters;
    auto& all = outcome.measurements;
    // A depth scale that is wrong in one direction only shears the angles of the plane.
    const Measurement rate = budgets.measure(
        "precession_rate",
        "rad/s",
        [](const SwingParameters& x) { return x.turning; },
        {.clock = p.turning, .scale = p.turning}
    );
    std::vector<Measurement> first{rate};
    if (std::abs(p.turning) < kEarth) {
        const double by_rate = 180.0 / pi / std::sqrt(kEarth * kEarth - p.turning * p.turning);
        first.push_back(budgets.measure(
            "latitude",
            "°",
            [](const SwingParameters& x) {
                return 180.0 / pi * std::asin(std::clamp(x.turning / kEarth, -1.0, 1.0));
            },
            {.clock = by_rate * p.turning, .scale = by_rate * p.turning}
        ));
        if (std::abs(p.turning) + 2.0 * rate.u > kEarth)
            outcome.warnings.push_back(fmt::format(
                "The plane turns by ({:.1f} ± {:.1f}) °/h, nearly as fast as the Earth itself: the "
                "latitude's uncertainty is not the same to both sides.",
                p.turning * 180.0 / pi * 3600.0,
                rate.u * 180.0 / pi * 3600.0
            ));
    } else {
        outcome.warnings.push_back(fmt::format(
            "The plane turns by ({:.1f} ± {:.1f}) °/h, faster than the Earth itself (15.04 °/h): "
            "no latitude follows from it. Something else turns it, such as a suspension that "
            "favours a direction.",
            p.turning * 180.0 / pi * 3600.0,
            rate.u * 180.0 / pi * 3600.0
        ));
    }
    if (swing.settings.metric) {
        first.push_back(budgets.measure("ellipse_a", "m", half_length, {.scale = half_length(p)}));
        first.push_back(budgets.measure("ellipse_b", "m", half_width, {.scale = half_width(p)}));
    } else {
        outcome.notes.emplace_back(
            "Positions are in pixels: the ellipse's half axes would be metres and are left out."
        );
    }
    const auto airy = [&](const SwingParameters& x) {
        return airy_rate(x, swing.duration_s);
    };
    first.push_back(budgets.measure("airy_rate", "rad/s", airy, {.clock = airy(p)}));
    all.insert(all.begin(), first.begin(), first.end());
    outcome.notes.push_back(fmt::format(
        "The ellipse of {:.2g} by {:.2g} of its length turns by itself by {:.2f} °/h; that is in "
        "the equation of motion and not in precession_rate.",
        half_length(p) / p.radius,
        std::abs(half_width(p)) / p.radius,
        airy(p) * 180.0 / pi * 3600.0
    ));
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& given,
    const AnalysisConditions& conditions
) {
    PendulumSettings settings = pendulum_settings(given, conditions);
    settings.turning_free = true;
    const auto swing = follow_swing(objects.front(), settings);
    if (!swing) return tl::unexpected(swing.error());
    if (swing->settings.flat)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "the motion is known in one plane only, which cannot show how that plane turns",
            "give positions of three dimensions, or analyse it as a pendulum"
        );
    if (!(swing->fit.free_turning_u < kRound))
        return fail(
            ErrorCode::bad_data,
            "samples",
            "the orbit is too round, or the run too short, to show the turning of a plane",
            "release the bob from rest, without a push to the side, and measure for minutes"
        );
    PendulumResult result = pendulum_result(*swing);
    std::erase_if(result.measurements, [](const auto& m) { return m.name == "turning_rate"; });
    AnalysisOutcome outcome;
    outcome.measurements = std::move(result.measurements);
    outcome.warnings = std::move(result.warnings);
    outcome.notes = std::move(result.notes);
    outcome.facts = swing_facts(*swing, outcome.measurements);
    add_turning(*swing, outcome);
    const SwingAxes axes = swing_axes(*swing);
    outcome.plots = {
        path_plot(
            result.fit, axes.centre, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), "x", "y"
        ),
        plane_angle_plot(*swing, axes),
        ellipse_plot(*swing, axes),
        position_plot(result.fit, axes.centre, axes.along),
        residual_plot(result.fit),
        amplitude_plot(*swing, axes)};
    if (!conditions.metric) label_pixels(outcome.plots);
    outcome.fits.push_back(std::move(result.fit));
    return outcome;
}

}  // namespace

AnalysisMethod foucault_method() {
    AnalysisMethod method;
    method.name = "foucault";
    method.settings = pendulum_setting_list();
    method.results = {
        "precession_rate",
        "latitude",
        "ellipse_a",
        "ellipse_b",
        "airy_rate",
        "g",
        "period",
        "small_angle_period",
        "amplitude",
        "damping",
        "quadratic_damping",
        "quality_factor"};
    method.plots = {"path", "plane_angle", "ellipse", "position", "residuals", "amplitude"};
    method.facts = {"periods", "gap_share", "amplitude_deg"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
