#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/fit_budget.hpp"
#include "pipeline/analysis/free_body.hpp"
#include "pipeline/analysis/mean_motion.hpp"
#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"

namespace kinectlab {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kEnoughForHalves = 40;
constexpr const char* kAxes[] = {"x", "y", "z"};

Result<FreeBodySettings> to_body(const AnalysisSettings& s) {
    FreeBodySettings body;
    body.mount_u_rad = s.at("mount_u_rad");
    body.size_u_m = s.at("size_u_m");
    body.alike = s.at("symmetry") > 0.5;
    const char* names[] = {"size_a_m", "size_b_m", "size_c_m"};
    Vector3d size;
    int given = 0;
    for (int i = 0; i < 3; ++i)
        if (const auto found = s.find(names[i]); found != s.end()) {
            size[i] = found->second;
            ++given;
        }
    if (given == 3) body.size_m = size;
    if (given == 1 || given == 2)
        return fail(
            ErrorCode::invalid_argument,
            "size_a_m",
            fmt::format("{} of the three sizes are given", given),
            "give size_a_m, size_b_m and size_c_m, or none of them"
        );
    return body;
}

/// Angular velocity at the start in the lab frame. A tilt of the lab frame turns it.
void add_rates(
    const FreeBody& body,
    const FreeBodySettings& settings,
    const AnalysisConditions& conditions,
    AnalysisOutcome& outcome
) {
    std::vector<std::string> priors(static_cast<std::size_t>(free_body::kCount));
    for (std::size_t i = 0; i < 3; ++i) {
        priors[6 + i] = "mount";
        priors[9 + i] = settings.size_m ? "size" : "shape";
    }
    const Vector3d rate = body.fit.parameters.segment<3>(free_body::kRate);
    const double tilt = conditions.tilt_u_rad;
    const double tilted[] = {
        std::abs(rate.z()) * tilt,
        std::abs(rate.z()) * tilt,
        std::hypot(rate.x(), rate.y()) * tilt};
    for (int i = 0; i < 3; ++i)
        outcome.measurements.push_back(measure(
            std::string("rate_") + kAxes[i],
            "rad/s",
            [i](const VectorXd& p) { return p[free_body::kRate + i]; },
            body.fit,
            priors,
            {{"clock", std::abs(rate[i]) * conditions.clock_u}, {"camera tilt", tilted[i]}}
        ));
    outcome.measurements.push_back(measure(
        "rate",
        "rad/s",
        [](const VectorXd& p) { return p.segment<3>(free_body::kRate).norm(); },
        body.fit,
        priors,
        {{"clock", rate.norm() * conditions.clock_u}}
    ));
}

/// Whether what has to stay constant without a torque does: both halves of the run, each fitted
/// alone.
void compare_halves(
    std::span<const AttitudeSample> samples,
    const FreeBodySettings& settings,
    AnalysisOutcome& outcome
) {
    if (samples.size() < kEnoughForHalves) return;
    const auto first = fit_free_body(samples.first(samples.size() / 2), settings);
    const auto second = fit_free_body(samples.subspan(samples.size() / 2), settings);
    if (!first || !second) return;
    const Vector3d before = first->momentum(first->fit.parameters);
    const Vector3d after = second->momentum(second->fit.parameters);
    const double turn = std::atan2(before.cross(after).norm(), before.dot(after));
    const double energy = first->energy(first->fit.parameters);
    outcome.facts["momentum_turn_deg"] = turn / kDegree;
    outcome.facts["energy_change_share"] = second->energy(second->fit.parameters) / energy - 1.0;
    double variance = 0.0;
    for (const FreeBody* half : {&*first, &*second})
        for (int i = 0; i < 3; ++i) {
            const auto part = [&](const VectorXd& p) {
                return half->momentum(p).normalized()[i];
            };
            const auto covariance = half->fit.covariance();
            const VectorXd g = gradient_of(part, half->fit.parameters, covariance);
            variance += g.dot(covariance * g);
        }
    if (turn > 4.0 * std::sqrt(variance) && turn > 1.0 * kDegree)
        outcome.warnings.push_back(fmt::format(
            "The angular momentum turned by {:.1f}° between the two halves of the run: something "
            "(air, a string, the shape that was given) turns the body.",
            turn / kDegree
        ));
}

void add_plots(
    const Trajectory& object,
    std::span<const AttitudeSample> samples,
    const FreeBody& body,
    AnalysisOutcome& outcome
) {
    std::vector<double> t;
    for (const auto& s : samples)
        t.push_back(s.t);
    std::vector<Quaterniond> q(t.size());
    std::vector<Vector3d> rate(t.size());
    body.motion(body.fit.parameters, t.front(), t, q, rate);
    Plot rates{"rates", "Angular velocity in the lab frame", "t / s", "ω / (rad/s)", false, {}};
    Plot residuals{
        "residuals", "Rotation: measured minus fitted", "t / s", "residual / mrad", false, {}};
    for (int i = 0; i < 3; ++i) {
        PlotSeries measured{std::string(kAxes[i]) + ", measured", PlotMark::points, t, {}, {}};
        PlotSeries fitted{std::string(kAxes[i]) + ", fit", PlotMark::line, t, {}, {}};
        PlotSeries off{kAxes[i], PlotMark::points, t, {}, {}};
        for (std::size_t k = 0; k < t.size(); ++k) {
            const MotionSample& seen = object.samples[samples[k].index];
            measured.y.push_back(seen.w_lab[i]);
            fitted.y.push_back(rate[k][i]);
            off.y.push_back(1e3 * Vector3d(samples[k].whiten.inverse() * body.fit.residuals[k])[i]);
        }
        rates.series.push_back(std::move(measured));
        rates.series.push_back(std::move(fitted));
        residuals.series.push_back(std::move(off));
    }
    outcome.plots.push_back(std::move(rates));
    outcome.plots.push_back(std::move(residuals));
    outcome.plots.push_back(path_plot(
        outcome.fits.front(), Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitZ(), "x", "z"
    ));
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& given,
    const AnalysisConditions& conditions
) {
    const auto settings = to_body(given);
    if (!settings) return tl::unexpected(settings.error());
    const Trajectory& object = objects.front();
    const auto samples = collect_attitudes(object, settings->alike);
    if (!samples) return tl::unexpected(samples.error());
    const auto body = fit_free_body(*samples, *settings);
    if (!body) return tl::unexpected(body.error());

    AnalysisOutcome outcome;
    add_rates(*body, *settings, conditions, outcome);
    if (auto ok = add_mean_motion(object, conditions, outcome); !ok)
        return tl::unexpected(ok.error());
    const double duration = samples->back().t - samples->front().t;
    const double frames = static_cast<double>(samples->back().index - samples->front().index + 1);
    const double rate = body->fit.parameters.segment<3>(free_body::kRate).norm();
    outcome.facts["duration_s"] = duration;
    outcome.facts["turns"] = rate * duration / (2.0 * std::numbers::pi);
    outcome.facts["gap_share"] = 1.0 - static_cast<double>(samples->size()) / frames;
    outcome.facts["outlier_share"] =
        static_cast<double>(body->fit.outliers) / static_cast<double>(samples->size());
    compare_halves(*samples, *settings, outcome);
    add_plots(object, *samples, *body, outcome);
    if (outcome.facts["outlier_share"] > 0.1)
        outcome.warnings.push_back(fmt::format(
            "{:.0f} % of the orientations do not fit a free body and were left out: is it really "
            "free, and is `symmetry` 1 for a box without marks?",
            100.0 * outcome.facts["outlier_share"]
        ));
    if (outcome.facts["turns"] < 1.0)
        outcome.warnings.emplace_back(
            "The body made less than one turn; two or more show its motion much better."
        );
    if (outcome.facts["gap_share"] > 0.2)
        outcome.warnings.push_back(fmt::format(
            "The orientation was not found in {:.0f} % of the frames.",
            100.0 * outcome.facts["gap_share"]
        ));
    outcome.notes.emplace_back(
        settings->size_m
            ? "The moments of inertia are those of a uniform box of the sizes given."
            : "No sizes were given: the ratios of the moments of inertia are fitted too, within a "
              "factor of e, which costs accuracy of the angular velocity."
    );
    if (body->fit.memory_s > 0.0)
        outcome.notes.push_back(fmt::format(
            "The orientations' noise stays alike for about {:.0f} ms, which is in the "
            "uncertainties.",
            1e3 * body->fit.memory_s
        ));
    return outcome;
}

}  // namespace

AnalysisMethod rigid_body_method() {
    AnalysisMethod method;
    method.name = "rigid_body";
    method.needs_orientation = true;
    method.settings = {
        {"size_a_m",
         0.001,
         100.0,
         {},
         "Edge along the object's x; with b and c the moments' ratios "
         "follow, else they are fitted."},
        {"size_b_m", 0.001, 100.0, {}, "Edge along the object's y."},
        {"size_c_m", 0.001, 100.0, {}, "Edge along the object's z."},
        {"size_u_m", 0.0, 1.0, 0.001, "Standard uncertainty of each edge."},
        {"mount_u_rad", 0.0, 0.5, 0.01, "How well the object's axes are its principal axes."},
        {"symmetry",
         0.0,
         1.0,
         0.0,
         "1: a box without marks, half turns about its axes look alike."}};
    method.results = {
        "rate_x",
        "rate_y",
        "rate_z",
        "rate",
        "position_x",
        "position_y",
        "position_z",
        "velocity_x",
        "velocity_y",
        "velocity_z"};
    method.plots = {"rates", "residuals", "path"};
    method.facts = {
        "duration_s",
        "turns",
        "gap_share",
        "outlier_share",
        "momentum_turn_deg",
        "energy_change_share"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
