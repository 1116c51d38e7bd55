#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"
#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/analysis/pendulum_settings.hpp"
#include "pipeline/analysis/swing_plots.hpp"

namespace kinectlab {
namespace {

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    const auto swing = follow_swing(objects.front(), pendulum_settings(settings, conditions));
    if (!swing) return tl::unexpected(swing.error());
    PendulumResult result = pendulum_result(*swing);
    AnalysisOutcome outcome;
    const SwingAxes axes = swing_axes(*swing);
    outcome.plots = {
        position_plot(result.fit, axes.centre, axes.along),
        residual_plot(result.fit),
        phase_plot(result.fit, swing->trajectory, axes.centre, axes.along),
        path_plot(result.fit, axes.centre, axes.along, axes.across, "x", "y"),
        amplitude_plot(*swing, axes),
        period_amplitude_plot(*swing, axes)};
    if (!conditions.metric) label_pixels(outcome.plots);
    outcome.facts = swing_facts(*swing, result.measurements);
    outcome.measurements = std::move(result.measurements);
    outcome.warnings = std::move(result.warnings);
    outcome.notes = std::move(result.notes);
    outcome.fits.push_back(std::move(result.fit));
    return outcome;
}

}  // namespace

AnalysisMethod pendulum_method() {
    AnalysisMethod method;
    method.name = "pendulum";
    method.settings = pendulum_setting_list();
    method.settings.push_back({"latitude_deg", -90.0, 90.0, 45.0, "Of the rig, north positive."});
    method.results = {
        "g",
        "period",
        "small_angle_period",
        "amplitude",
        "damping",
        "quadratic_damping",
        "quality_factor",
        "turning_rate"};
    method.plots = {"position", "residuals", "phase", "path", "amplitude", "period_amplitude"};
    method.facts = {"periods", "gap_share", "amplitude_deg"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
