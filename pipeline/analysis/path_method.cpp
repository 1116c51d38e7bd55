#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/fit_budget.hpp"
#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"
#include "pipeline/analysis/path_numbers.hpp"
#include "pipeline/analysis/path_plots.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;

struct Number {
    const char* name;
    const char* unit;
    PathNumber value;
    int lengths;  // power of a metre
    int times;    // power of a second
    double gaps;  // uncertainty by what was not seen
    double smoothing;
};

void add_measurements(
    const PathNumbers& numbers,
    double duration,
    const AnalysisConditions& conditions,
    AnalysisOutcome& outcome
) {
    const auto over = [&](const PathNumber& n) {
        return PathNumber{n.value / duration, n.u / duration};
    };
    const double gaps = numbers.gaps_u;
    const double bias = numbers.smoothing_share;
    const Number all[] = {
        {"path_length", "m", numbers.length, 1, 0, gaps, bias * numbers.length.value},
        {"mean_speed",
         "m/s",
         over(numbers.length),
         1,
         -1,
         gaps / duration,
         bias * numbers.length.value / duration},
        {"greatest_speed",
         "m/s",
         numbers.greatest_speed,
         1,
         -1,
         0.0,
         bias * numbers.greatest_speed.value},
        {"displacement", "m", numbers.displacement, 1, 0, 0.0, 0.0},
        {"total_turn", "rad", numbers.turn, 0, 0, 0.0, 0.0},
        {"mean_turning_rate", "rad/s", over(numbers.turn), 0, -1, 0.0, 0.0},
        {"duration", "s", {duration, 0.0}, 0, 1, 0.0, 0.0}};
    for (const Number& n : all) {
        if (n.lengths != 0 && !conditions.metric) continue;
        if (!std::isfinite(n.value.value)) continue;
        Measurement m{n.name, n.value.value, 0.0, n.unit, {{"statistics", n.value.u}}};
        const double size = std::abs(m.value);
        if (n.lengths != 0) {
            m.budget.push_back({"depth scale", size * conditions.depth_scale_u});
            // What a tilted floor plan loses of a length.
            m.budget.push_back({"camera tilt", 0.5 * size * std::pow(conditions.tilt_u_rad, 2)});
        }
        if (n.times != 0) m.budget.push_back({"clock", size * conditions.clock_u});
        if (n.gaps > 0.0) m.budget.push_back({"gaps", n.gaps});
        if (n.smoothing > 0.0) m.budget.push_back({"smoothing", n.smoothing});
        m.u = combined(m.budget);
        outcome.measurements.push_back(std::move(m));
    }
}

void add_words(
    const SmoothPath& path,
    const PathNumbers& numbers,
    double half_window_s,
    const AnalysisConditions& conditions,
    AnalysisOutcome& outcome
) {
    outcome.notes.push_back(fmt::format(
        "Smoothed by local cubics over {:.2f} s to each side: speeds are passed up to {:.1f} Hz "
        "(-3 dB).",
        half_window_s,
        0.7047 / half_window_s
    ));
    outcome.notes.emplace_back(
        "The length is the integral of the smoothed speed, less what noise across the path adds "
        "to it; where the speed is below three times its uncertainty the object counts as standing."
    );
    outcome.notes.emplace_back(
        path.has_heading ? "The heading is that of the object's own x axis."
                         : "The object's own heading was not seen; the heading is the direction in "
                           "which it moves, and reversing looks like half a turn."
    );
    if (!conditions.metric)
        outcome.notes.emplace_back(
            "Positions are in pixels: lengths and speeds are left out, turning needs no metre."
        );
    if (outcome.facts["gap_share"] > 0.2)
        outcome.warnings.push_back(fmt::format(
            "The object was not found in {:.0f} % of the frames.",
            100.0 * outcome.facts["gap_share"]
        ));
    if (numbers.gaps_s > 0.0)
        outcome.warnings.push_back(fmt::format(
            "The path was out of sight for {:.1f} s in all; a straight line stands there for the "
            "length.",
            numbers.gaps_s
        ));
    if (outcome.facts["standing_share"] > 0.2)
        outcome.warnings.push_back(fmt::format(
            "It stood, or moved too slowly to be told from noise, for {:.0f} % of the time.",
            100.0 * outcome.facts["standing_share"]
        ));
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    const Trajectory& object = objects.front();
    const double half_window = settings.at("half_window_s");
    const auto path = smooth_path(object, half_window);
    if (!path) return tl::unexpected(path.error());
    const auto numbers = path_numbers(*path, half_window);
    if (!numbers) return tl::unexpected(numbers.error());

    AnalysisOutcome outcome;
    const double duration = path->samples.back().t - path->samples.front().t;
    const auto frames =
        static_cast<double>(path->samples.back().index - path->samples.front().index + 1);
    outcome.facts = {
        {"duration_s", duration},
        {"gap_share",
         1.0 -
             static_cast<double>(path->samples.size() + static_cast<std::size_t>(path->outliers)) /
                 frames},
        {"outlier_share", path->outliers / frames},
        {"standing_share", numbers->standing_share}};
    outcome.facts["gap_share"] = std::max(outcome.facts["gap_share"], 0.0);
    add_measurements(*numbers, duration, conditions, outcome);

    ObjectFit fit = plotted_fit(object, [](double) {
        return Vector3d(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    });
    for (std::size_t i = 0; i < path->samples.size(); ++i) {
        const std::size_t at = path->samples[i].index;
        const Vector3d& smooth = path->points[i].value;
        fit.fit_lab[at] = {smooth.x(), smooth.y(), object.samples[at].p_lab.z()};
        fit.residual[at] = fit.p_lab[at] - fit.fit_lab[at];
    }
    fit.used = static_cast<int>(path->samples.size());
    fit.outliers = path->outliers;
    fit.reduced_chi2 = path->reduced_chi2;
    outcome.plots = path_plots(*path, fit, *numbers, conditions.metric);
    outcome.plots.push_back(residual_plot(fit));
    outcome.fits.push_back(std::move(fit));
    add_words(*path, *numbers, half_window, conditions, outcome);
    return outcome;
}

}  // namespace

AnalysisMethod path_method() {
    AnalysisMethod method;
    method.name = "path";
    method.settings = {
        {"half_window_s",
         0.1,
         10.0,
         0.5,
         "Of the local cubics that smooth the path; longer is calmer and rounds corners."}};
    method.results = {
        "path_length",
        "mean_speed",
        "greatest_speed",
        "displacement",
        "total_turn",
        "mean_turning_rate",
        "duration"};
    method.plots = {"map", "speed", "turning", "heading", "residuals"};
    method.facts = {"duration_s", "gap_share", "outlier_share", "standing_share"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
