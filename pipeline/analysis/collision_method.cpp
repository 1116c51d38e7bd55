#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "pipeline/analysis/collision_measurements.hpp"
#include "pipeline/analysis/fit_budget.hpp"
#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kGravity = 9.81;       // m/s², turns a table's slope into an acceleration
constexpr double kPlausibleDrag = 0.3;  // 1/s, of balls on air, gliders and rolling balls
constexpr std::size_t kFewFrames = 15;

struct Ball {
    const Trajectory* trajectory = nullptr;
    std::vector<PositionSample> samples;
    double late = 0.0;  // s, its first sample after the first of both
};

Result<std::array<Ball, 2>> collect(std::span<const Trajectory> objects) {
    std::array<Ball, 2> balls;
    TimeNs start = std::numeric_limits<TimeNs>::max();
    for (const auto& object : objects)
        if (!object.samples.empty()) start = std::min(start, object.samples.front().t);
    for (std::size_t k = 0; k < 2; ++k) {
        auto samples = collect_position_samples(objects[k], 6);
        if (!samples) {
            Error error = samples.error();
            error.message = objects[k].object + ": " + error.message;
            return tl::unexpected(error);
        }
        balls[k] = {&objects[k], std::move(*samples), 0.0};
        balls[k].late = to_seconds(objects[k].samples.front().t - start);
        for (auto& s : balls[k].samples)
            s.t += balls[k].late;
    }
    return balls;
}

ObjectFit plotted(const Ball& ball, std::size_t k, const Impact& impact, const ResidualFit& fit) {
    const double first = ball.samples[impact.moving[k].begin].t - 1e-9;
    const double last = ball.samples[impact.moving[k].end - 1].t + 1e-9;
    ObjectFit plot = plotted_fit(*ball.trajectory, [&](double t) -> Vector3d {
        t += ball.late;
        if (t < first || t > last)
            return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
        return collision::position(fit.parameters, k, t);
    });
    const std::size_t offset =
        k == 0 ? 0 : fit.used.size() - (impact.moving[1].end - impact.moving[1].begin);
    for (std::size_t i = 0; i < impact.moving[k].end - impact.moving[k].begin; ++i)
        ++(fit.used[offset + i] ? plot.used : plot.outliers);
    plot.reduced_chi2 = fit.reduced_chi2;
    return plot;
}

/// Both balls' curves in one picture, named after them.
Plot together(Plot a, Plot b, const std::string& name_a, const std::string& name_b) {
    for (auto& one : a.series)
        one.name = name_a + ", " + one.name;
    for (auto& one : b.series) {
        one.name = name_b + ", " + one.name;
        a.series.push_back(std::move(one));
    }
    return a;
}

/// A number against time on both sides of the impact, from the fit.
Plot over_time(
    const std::array<Ball, 2>& balls,
    const ResidualFit& fit,
    const std::string& name,
    const std::string& title,
    const std::string& label,
    const std::function<double(const Vector3d& a, const Vector3d& b)>& number
) {
    Plot plot{name, title, "t / s", label, false, {}};
    PlotSeries line{"both balls, fit", PlotMark::line, {}, {}, {}};
    PlotSeries points{"both balls, measured", PlotMark::points, {}, {}, {}};
    const VectorXd& p = fit.parameters;
    for (const auto& s : balls[0].samples) {
        const bool before = s.t < p[collision::kTime];
        const double fade = std::exp(-p[collision::kDrag] * (s.t - p[collision::kTime]));
        const Vector3d a = before ? collision::before(p, 0) : collision::after(p, 0);
        const Vector3d b = before ? collision::before(p, 1) : collision::after(p, 1);
        line.x.push_back(s.t);
        line.y.push_back(number(a * fade, b * fade));
        const MotionSample& seen = balls[0].trajectory->samples[s.index];
        const auto& others = balls[1].trajectory->samples;
        const auto other = std::lower_bound(
            others.begin(),
            others.end(),
            seen.t,
            [](const MotionSample& m, TimeNs t) { return m.t < t; }
        );
        if (other == others.end() || other->t != seen.t) continue;
        points.x.push_back(s.t);
        points.y.push_back(number(seen.v_lab, other->v_lab));
    }
    plot.series = {std::move(points), std::move(line)};
    return plot;
}

void add_plots(
    const std::array<Ball, 2>& balls,
    const ResidualFit& fit,
    const BallMasses& masses,
    AnalysisOutcome& outcome
) {
    const VectorXd& p = fit.parameters;
    const Vector3d origin = 0.5 * (collision::centre(p, 0) + collision::centre(p, 1));
    const Vector3d along = collision::approach(p);
    const Vector3d across = Vector3d::UnitZ().cross(along);
    const ObjectFit& a = outcome.fits[0];
    const ObjectFit& b = outcome.fits[1];
    const auto pair = [&](Plot of_a, Plot of_b) {
        outcome.plots.push_back(together(std::move(of_a), std::move(of_b), a.object, b.object));
    };
    const char* title = "Positions along the line of approach";
    pair(
        position_plot(a, origin, along, "positions", title),
        position_plot(b, origin, along, "positions", title)
    );
    pair(residual_plot(a), residual_plot(b));
    pair(
        path_plot(a, origin, along, across, "along", "across"),
        path_plot(b, origin, along, across, "along", "across")
    );
    outcome.plots.push_back(over_time(
        balls,
        fit,
        "energy",
        "Kinetic energy of both",
        "E / J",
        [&](const Vector3d& va, const Vector3d& vb) {
            return 0.5 * (masses.a * va.squaredNorm() + masses.b * vb.squaredNorm());
        }
    ));
    outcome.plots.push_back(over_time(
        balls,
        fit,
        "momentum",
        "Momentum of both along the line of approach",
        "p / (kg m/s)",
        [&](const Vector3d& va, const Vector3d& vb) {
            return (masses.a * va + masses.b * vb).dot(along);
        }
    ));
}

void add_warnings(
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions,
    const ResidualFit& fit,
    AnalysisOutcome& outcome
) {
    const auto fewest = std::min(outcome.facts["frames_before"], outcome.facts["frames_after"]);
    if (fewest < static_cast<double>(kFewFrames))
        outcome.warnings.push_back(fmt::format(
            "Only {:.0f} frames on one side of the impact could be used; half a second of free "
            "motion on each side gives much better velocities.",
            fewest
        ));
    if (outcome.facts["gap_share"] > 0.2)
        outcome.warnings.push_back(fmt::format(
            "The balls were hidden or not found in {:.0f} % of the frames.",
            100.0 * outcome.facts["gap_share"]
        ));
    for (const auto& m : outcome.measurements) {
        if (m.name == "restitution" && m.value > 1.0 + 3.0 * m.u)
            outcome.warnings.emplace_back(
                "More relative speed after the impact than before it: a spring, magnets or a hand?"
            );
        if (m.name == "momentum_balance" && std::abs(m.value) > 3.0 * m.u)
            outcome.warnings.push_back(fmt::format(
                "Momentum changed by {:.2g} ± {:.2g} kg m/s: are the masses right, and does "
                "nothing else push?",
                m.value,
                m.u
            ));
    }
    const auto a = settings.find("radius_a_m");
    const auto b = settings.find("radius_b_m");
    if (!conditions.metric || a == settings.end() || b == settings.end()) return;
    const auto distance = [](const VectorXd& p) {
        return (collision::centre(p, 1) - collision::centre(p, 0)).norm();
    };
    const VectorXd g = gradient_of(distance, fit.parameters, fit.covariance());
    const double seen = distance(fit.parameters);
    const double u =
        std::hypot(std::sqrt(g.dot(fit.covariance() * g)), seen * conditions.depth_scale_u);
    const double touching = a->second + b->second;
    if (std::abs(seen - touching) > 4.0 * u + 0.02 * touching)
        outcome.warnings.push_back(fmt::format(
            "At the impact the centres were {:.1f} mm apart; the radii say {:.1f} mm. Are radii "
            "and "
            "calibration right?",
            seen * 1e3,
            touching * 1e3
        ));
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    const auto balls = collect(objects);
    if (!balls) return tl::unexpected(balls.error());
    const std::array<std::span<const PositionSample>, 2> samples{
        (*balls)[0].samples, (*balls)[1].samples};
    const auto impact = find_impact(samples[0], samples[1], settings.at("window_s"));
    if (!impact) return tl::unexpected(impact.error());
    CollisionPriors priors;
    priors.drag_u = settings.at("drag") > 0.5 ? kPlausibleDrag : 0.0;
    priors.slope_u = conditions.metric ? kGravity * settings.at("slope_u_rad") : 0.0;
    const auto fit = fit_collision(samples, *impact, priors);
    if (!fit) return tl::unexpected(fit.error());

    AnalysisOutcome outcome;
    const BallMasses masses{
        settings.at("mass_a_kg"), settings.at("mass_b_kg"), settings.at("mass_u_kg")};
    const double t0 = fit->parameters[collision::kTime];
    double before = std::numeric_limits<double>::infinity();
    double after = before;
    double lost = 0.0;
    double all = 0.0;
    double first = 0.0;
    double last = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 2; ++k) {
        const SampleRange range = impact->moving[k];
        double early = 0.0;
        for (std::size_t i = range.begin; i < range.end; ++i)
            early += samples[k][i].t < t0 ? 1.0 : 0.0;
        before = std::min(before, early);
        after = std::min(after, static_cast<double>(range.end - range.begin) - early);
        const auto frames = static_cast<double>(
            samples[k][range.end - 1].index - samples[k][range.begin].index + 1
        );
        all += frames;
        lost += frames - static_cast<double>(range.end - range.begin);
        first = std::max(first, samples[k][range.begin].t);
        last = std::min(last, samples[k][range.end - 1].t);
        outcome.fits.push_back(plotted((*balls)[k], k, *impact, *fit));
    }
    outcome.facts = {
        {"duration_s", last - first},
        {"frames_before", before},
        {"frames_after", after},
        {"gap_share", lost / all}};
    add_collision_measurements(*fit, masses, conditions, outcome);
    add_plots(*balls, *fit, masses, outcome);
    if (!conditions.metric)
        std::erase_if(outcome.plots, [](const Plot& plot) {
            return plot.name == "energy" || plot.name == "momentum";
        });
    add_warnings(settings, conditions, *fit, outcome);
    outcome.notes.push_back(fmt::format(
        "From {:.2f} s to {:.2f} s both balls moved freely; the rest was left out.", first, last
    ));
    if (fit->memory_s > 0.0)
        outcome.notes.push_back(fmt::format(
            "The positions' noise stays alike for about {:.0f} ms, which is in the uncertainties.",
            1e3 * fit->memory_s
        ));
    return outcome;
}

}  // namespace

AnalysisMethod collision_method() {
    AnalysisMethod method;
    method.name = "collision";
    method.objects = 2;
    method.settings = {
        {"mass_a_kg", 1e-4, 1e4, {}, "Of the first object.", true},
        {"mass_b_kg", 1e-4, 1e4, {}, "Of the second object.", true},
        {"mass_u_kg", 0.0, 1e3, 0.0, "Standard uncertainty of each mass."},
        {"radius_a_m", 1e-4, 10.0, {}, "Checks that the balls touch; nothing rests on it."},
        {"radius_b_m", 1e-4, 10.0, {}, "Checks that the balls touch; nothing rests on it."},
        {"drag", 0.0, 1.0, 1.0, "1: drag proportional to the speed is fitted, 0: there is none."},
        {"slope_u_rad", 0.0, 0.1, 0.001, "How well the table is levelled; 0.001 is 1 mm in 1 m."},
        {"window_s", 0.1, 100.0, 3.0, "Longest stretch used before and after the impact."}};
    method.results = {
        "speed_a_before",
        "speed_b_before",
        "speed_a_after",
        "speed_b_after",
        "momentum_before",
        "momentum_after",
        "momentum_balance",
        "momentum_balance_across",
        "energy_before",
        "energy_after",
        "energy_lost_share",
        "restitution",
        "impact_time"};
    method.plots = {"positions", "residuals", "path", "energy", "momentum"};
    method.facts = {"duration_s", "frames_before", "frames_after", "gap_share"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
