#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"
#include "pipeline/analysis/path_report.hpp"
#include "pipeline/analysis/spring_guess.hpp"
#include "pipeline/analysis/spring_measurements.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kFewPeriods = 8.0;
constexpr double kSteep = 0.17;  // rad off the vertical that is worth a word

std::vector<PathParameter> start_at(
    const VectorXd& x, double length, const AnalysisSettings& settings
) {
    const bool driven = settings.at("drive_hz") > 0.0;
    std::vector<PathParameter> all(kSpringParameters);
    for (int i = 0; i < kSpringParameters; ++i)
        all[static_cast<std::size_t>(i)] = {x[i], 0.01 * length, 0.0, -1};
    const double omega = x[kSpringOmega];
    all[kSpringLeanA].scale = all[kSpringLeanB].scale = 0.02;
    all[kSpringOmega].scale = 1e-3 * omega;
    all[kSpringDamping].scale = 1e-3 * omega;
    const double quadratic_u = driven ? 0.0 : kSpringQuadraticUnknown / length;
    all[kSpringQuadratic] = {0.0, 0.02 / length, 0.0, quadratic_u};
    const double drive = 2.0 * pi * settings.at("drive_hz");
    all[kSpringDriveOmega] = {drive, 1e-3 * drive, drive, 2.0 * pi * settings.at("drive_u_hz")};
    if (driven) {
        // Weak: where the start has died away the data say nothing of them.
        all[kSpringOmega].prior = omega;
        all[kSpringOmega].prior_u = omega;
        all[kSpringDamping].prior = x[kSpringDamping];
        all[kSpringDamping].prior_u = omega;
    } else {
        for (const int i : {kSpringDriveOmega, kSpringDriveCos, kSpringDriveSin})
            all[static_cast<std::size_t>(i)] = {0.0, 1.0, 0.0, 0.0};
    }
    return all;
}

void warn(
    AnalysisOutcome& out,
    const PathFit& fit,
    const SpringAxes& axes,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    const double lean =
        std::acos(std::min(1.0, std::abs(spring_direction(fit.parameters, axes).z())));
    if (lean > kSteep + 3.0 * conditions.tilt_u_rad)
        out.warnings.push_back(fmt::format(
            "It moves along a line {:.0f}° off the vertical; does it swing like a pendulum too?",
            lean * 180.0 / pi
        ));
    if (out.facts.contains("periods") && out.facts["periods"] < kFewPeriods)
        out.warnings.push_back(fmt::format(
            "Only {:.1f} periods were recorded; ten or more give a much better damping.",
            out.facts["periods"]
        ));
    const VectorXd& x = fit.parameters;
    const double damping_u = std::sqrt(fit.covariance()(kSpringDamping, kSpringDamping));
    if (settings.at("drive_hz") == 0.0 && x[kSpringDamping] < -4.0 * damping_u)
        out.warnings.emplace_back(
            "The motion grew by itself; something drives the mass: give drive_hz."
        );
    if (!conditions.metric)
        out.notes.emplace_back(
            "The positions are in pixels of unknown size: amplitudes and quadratic drag are left "
            "out."
        );
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    const Trajectory& trajectory = objects.front();
    const auto collected = collect_position_samples(trajectory);
    if (!collected) return tl::unexpected(collected.error());
    const std::span<const PositionSample> samples = *collected;
    const double length = conditions.metric ? 1.0 : std::max(extent_of(samples), 1e-9);
    const double drive = 2.0 * pi * settings.at("drive_hz");
    auto guess = guess_spring(samples, drive);
    if (!guess) return tl::unexpected(guess.error());
    const SpringAxes axes = guess->axes;
    const auto model_from = [axes](double from) -> PathModel {
        return [axes, from](const VectorXd& x, std::span<const double> t, std::span<Vector3d> p) {
            spring_path(x, axes, from, t, p);
        };
    };
    const PathModel rough = model_from(guess->t0);
    const double period = 2.0 * pi / (drive > 0.0 ? drive : guess->parameters[kSpringOmega]);
    PathFitSettings fit_settings;
    fit_settings.correlation_time_s = period / 4.0;
    VectorXd at = guess->parameters;
    const auto predict = [&](const Stretch& s, std::span<const PositionSample> around) {
        const auto fit = fit_path(
            samples.subspan(s.begin, s.size()), rough, start_at(at, length, settings), fit_settings
        );
        std::vector<Vector3d> p(fit ? around.size() : 0);
        std::vector<double> t;
        for (const auto& sample : around)
            t.push_back(sample.t);
        if (!fit) return p;
        at = fit->parameters;
        rough(at, t, p);
        return p;
    };
    const double step =
        (samples.back().t - samples.front().t) / static_cast<double>(samples.size());
    const auto block =
        std::max<std::size_t>(5, static_cast<std::size_t>(std::lround(period / 4.0 / step)));
    Stretch stretch = grow_stretch(samples, guess->known, predict, block, 3);
    const double share = 0.5 * period / (samples[stretch.end - 1].t - samples[stretch.begin].t);
    stretch = without_ends(samples, stretch, std::min(share, 0.1), block / 2);
    const double begin = samples[stretch.begin].t;
    const double duration = samples[stretch.end - 1].t - begin;
    if (duration < 2.5 * period)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format("it swings freely for {:.1f} periods only", duration / period),
            "let it swing for three periods or more before it is touched"
        );
    const PathModel model = model_from(begin);
    const auto fit = fit_path(
        samples.subspan(stretch.begin, stretch.size()),
        model,
        start_at(spring_later(at, begin - guess->t0), length, settings),
        fit_settings
    );
    if (!fit) return tl::unexpected(fit.error());
    if (!std::isfinite(damped_omega(fit->parameters)))
        return fail(
            ErrorCode::bad_data,
            "samples",
            "it creeps back without swinging",
            "use a heavier mass, or less damping"
        );

    AnalysisOutcome out;
    out.facts = stretch_facts(samples, stretch);
    const double shown = drive > 0.0 ? drive : damped_omega(fit->parameters);
    out.facts["periods"] = duration * shown / (2.0 * pi);
    spring_measurements(out, *fit, settings, conditions, length);
    out.warnings =
        stretch_warnings(samples, stretch, *fit, "a free swing on the spring", conditions.metric);
    warn(out, *fit, axes, settings, conditions);
    out.fits.push_back(path_for_plots(trajectory, samples, stretch, model, *fit));
    const Vector3d origin = fit->parameters.head<3>();
    const Vector3d along = spring_direction(fit->parameters, axes);
    const ObjectFit& plotted = out.fits.front();
    out.plots = {
        position_plot(plotted, origin, along),
        residual_plot(plotted),
        phase_plot(plotted, trajectory, origin, along),
        velocity_plot(plotted, trajectory, along)};
    if (!conditions.metric) label_in_pixels(out.plots);
    return out;
}

}  // namespace

AnalysisMethod spring_method() {
    AnalysisMethod method;
    method.name = "spring";
    method.settings = {
        {"mass_kg", 1e-4, 100.0, {}, "What hangs on the spring; without it there is no stiffness."},
        {"mass_u_kg", 0.0, 10.0, 1e-4, "Standard uncertainty of mass_kg."},
        {"spring_mass_kg",
         0.0,
         10.0,
         {},
         "A third of it swings along; without it up to 10 % of mass_kg is in the budget."},
        {"drive_hz", 0.0, 20.0, 0.0, "Of a drive at a steady frequency; 0 = none."},
        {"drive_u_hz", 0.0, 1.0, 0.001, "Standard uncertainty of drive_hz."}};
    method.results = {
        "period",
        "angular_frequency",
        "stiffness",
        "damping",
        "quadratic_drag",
        "quality_factor",
        "amplitude",
        "steady_amplitude",
        "phase_lag",
        "resonance_frequency"};
    method.plots = {"position", "residuals", "phase", "velocity"};
    method.facts = {"periods", "duration_s", "start_s", "gap_share"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
