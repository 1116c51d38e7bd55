#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/incline_model.hpp"
#include "pipeline/analysis/incline_rolling.hpp"
#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"
#include "pipeline/analysis/path_budget.hpp"
#include "pipeline/analysis/path_report.hpp"
#include "pipeline/analysis/path_stretch.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kFewest = 10;    // positions of a roll
constexpr double kShortest = 0.3;      // s
constexpr double kLevel = 0.01;        // sine of a slope that is none
constexpr double kSteepest = 0.98;     // sine of a slope from which things fall
constexpr double kStraight = 0.25;     // share of the acceleration that may point off the line
constexpr double kDragUnknown = 0.02;  // 1/s
constexpr double kResistanceUnknown = 1e-3;  // of a hard ball on wood or metal
constexpr double kEndShare = 0.04;

struct Roll {
    ParabolaStretch stretch;
    Vector3d down = Vector3d::UnitX();  ///< along the line, the way the acceleration points
};

std::optional<Roll> as_roll(const ParabolaStretch& s, std::span<const PositionSample> samples) {
    const double t = samples[s.samples.end - 1].t - samples[s.samples.begin].t;
    const double size = s.a.norm();
    if (s.samples.size() < kFewest || t < kShortest || size < 5.0 * s.u_a.norm())
        return std::nullopt;
    const Vector3d way = s.v * t + s.a * t * t / 2;
    const double path = (std::abs(s.v.dot(s.a)) / size + size * t / 2) * t;
    Roll roll{s, s.a / size};
    if (way.norm() > 0.3 * path) roll.down = way.normalized() * (way.dot(s.a) < 0.0 ? -1.0 : 1.0);
    const double off = (s.a - s.a.dot(roll.down) * roll.down).norm();
    if (off > kStraight * size + 3.0 * s.u_a.norm()) return std::nullopt;
    if (-roll.down.z() < kLevel || -roll.down.z() > kSteepest) return std::nullopt;
    return roll;
}

Result<Roll> find_roll(std::span<const PositionSample> samples) {
    std::optional<Roll> best;
    double farthest = 0.0;
    bool moves = false;
    bool falls = false;
    for (const auto& s : parabola_stretches(samples)) {
        const double t = samples[s.samples.end - 1].t - samples[s.samples.begin].t;
        const double size = s.a.norm();
        moves = moves || s.v.norm() * t > 10.0 * s.u_a.norm() * t * t;
        falls = falls || (size > 5.0 * s.u_a.norm() && -s.a.z() > kSteepest * size);
        const auto roll = as_roll(s, samples);
        if (!roll || size * t * t < farthest) continue;
        farthest = size * t * t;
        best = roll;
    }
    if (best) return *best;
    std::string why = "nothing moves along a slope faster and faster";
    if (falls)
        why = "what moves falls straight down, not along a slope";
    else if (moves)
        why = "it moves, but without speeding up along a straight slope";
    return fail(
        ErrorCode::bad_data,
        "samples",
        why,
        fmt::format(
            "tilt the plank by a degree or more and let the ball go with all of its way in view, "
            "for {} s or longer",
            kShortest
        )
    );
}

std::vector<PathParameter> start_at(const Roll& roll, double later, double length) {
    std::vector<PathParameter> all(kInclineParameters);
    const Vector3d& e = roll.down;
    const double v = roll.stretch.v.dot(e);
    const double a = roll.stretch.a.dot(e);
    const Vector3d p = roll.stretch.p + e * (v * later + a * later * later / 2);
    for (int k = 0; k < 3; ++k)
        all[static_cast<std::size_t>(k)] = {p[k], 0.01 * length, 0.0, -1};
    all[kInclineHeading] = {std::atan2(e.y(), e.x()), 0.01, 0.0, -1};
    all[kInclineSlope] = {std::asin(-e.z()), 0.01, 0.0, -1};
    all[kInclineV] = {v + a * later, 0.1 * length, 0.0, -1};
    all[kInclineA] = {a, 0.1 * length, 0.0, -1};
    all[kInclineDrag] = {0.0, kDragUnknown, 0.0, kDragUnknown};
    return all;
}

/// The angle of the plank: given, or that of the path. Lines of its own are in radians.
struct Angle {
    std::optional<double> given;
    BudgetLine line;

    [[nodiscard]] double of(const VectorXd& x) const { return given.value_or(x[kInclineSlope]); }
};

Angle angle_of(const AnalysisSettings& s, const AnalysisConditions& conditions) {
    const auto given = s.find("incline_deg");
    if (given == s.end()) return {std::nullopt, {"camera tilt", conditions.tilt_u_rad}};
    return {given->second * kDegree, {"incline", s.at("incline_u_deg") * kDegree}};
}

void measure(
    AnalysisOutcome& out,
    const PathFit& fit,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    const Angle angle = angle_of(settings, conditions);
    const VectorXd& x = fit.parameters;
    const PathBudget budget(fit, {{"drag", {kInclineDrag}}}, conditions);
    const double alpha = angle.of(x);
    Measurement slope = budget.measure(
        "angle", "rad", [&](const VectorXd& y) { return angle.of(y); }, {}, {angle.line}
    );
    const Measurement seen =
        budget.measure("", "", [](const VectorXd& y) { return y[kInclineSlope]; }, {});
    out.facts["path_angle_deg"] = seen.value / kDegree;
    if (angle.given) {
        out.facts["path_minus_plank_deg"] = (seen.value - alpha) / kDegree;
        out.notes.push_back(fmt::format(
            "The angle is the plank's, {:.2f}° ± {:.2f}°; the ball's path leans by {:.2f}° ± "
            "{:.2f}° (without the camera's tilt).",
            alpha / kDegree,
            slope.u / kDegree,
            seen.value / kDegree,
            seen.u / kDegree
        ));
    } else {
        out.notes.emplace_back("The angle is that of the ball's path.");
    }
    if (angle.given &&
        std::abs(seen.value - alpha) > 4.0 * std::hypot(seen.u, slope.u) + conditions.tilt_u_rad)
        out.warnings.push_back(fmt::format(
            "The ball's path leans by {:.1f}° but the plank by {:.1f}°; is the angle right?",
            seen.value / kDegree,
            alpha / kDegree
        ));
    if (!conditions.metric) {
        out.measurements.push_back(slope);
        out.notes.emplace_back(
            "The positions are in pixels of unknown size: acceleration and g are left out."
        );
        return;
    }
    const auto acceleration = [](const VectorXd& y) {
        return y[kInclineA];
    };
    out.measurements.push_back(budget.measure("acceleration", "m/s²", acceleration, {1, -2}));
    out.measurements.push_back(slope);
    const Measurement drag =
        budget.measure("drag", "1/s", [](const VectorXd& y) { return y[kInclineDrag]; }, {0, -1});

    const double a = x[kInclineA];
    const auto resistance = settings.find("rolling_resistance");
    const double mu = resistance == settings.end() ? 0.0 : resistance->second;
    const double inertia =
        rolling_inertia(settings.at("ball_radius_m"), settings.at("groove_width_m"));
    const auto rolling = [&](const VectorXd& y) {
        return inertia * y[kInclineA] / (std::sin(angle.of(y)) - mu * std::cos(angle.of(y)));
    };
    const double g = rolling(x);
    std::vector<BudgetLine> more{{angle.line.source, g / std::tan(alpha) * angle.line.u}};
    if (resistance == settings.end()) {
        more.push_back({"rolling resistance", g / std::tan(alpha) * kResistanceUnknown});
        out.notes.emplace_back(
            "The rolling resistance was not given; that it may be 0.001 stands in the budget."
        );
    }
    const Measurement by_rolling = budget.measure("g", "m/s²", rolling, {1, -2}, more);
    std::optional<double> latitude;
    if (const auto it = settings.find("latitude_deg"); it != settings.end()) latitude = it->second;
    const LocalGravity local = local_gravity(latitude);
    const RollingDecision decision = decide_rolling(by_rolling, inertia, local);
    if (!conditions.on_earth) {
        out.notes.emplace_back(
            "g takes for granted that the ball rolls without sliding: where g is not the Earth's "
            "there is nothing to tell it by."
        );
    } else {
        out.facts["rolling_probability"] = decision.rolling;
        out.notes.push_back(decision.text);
        if (decision.warning) out.warnings.push_back(*decision.warning);
    }
    if (conditions.on_earth && decision.rolling < kSurelySliding) {
        const auto friction = [&](const VectorXd& y) {
            return std::tan(angle.of(y)) - y[kInclineA] / (local.g * std::cos(angle.of(y)));
        };
        const double along = a / (local.g * std::cos(alpha));
        const double by_angle = 1.0 / std::pow(std::cos(alpha), 2) - along * std::tan(alpha);
        out.measurements.push_back(budget.measure(
            "friction",
            "1",
            friction,
            {},
            {{angle.line.source, std::abs(by_angle) * angle.line.u},
             {"depth scale", along * conditions.depth_scale_u},
             {"clock", 2.0 * along * conditions.clock_u},
             {"local g", along * local.u / local.g}}
        ));
    } else {
        out.measurements.push_back(by_rolling);
    }
    if (drag.u < 0.7 * kDragUnknown) out.measurements.push_back(drag);
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    if (settings.at("groove_width_m") >= 2.0 * settings.at("ball_radius_m") &&
        settings.at("groove_width_m") > 0.0)
        return fail(
            ErrorCode::invalid_argument,
            "groove_width_m",
            "is not narrower than the ball",
            "give ball_radius_m too, and a groove on whose edges the ball rolls"
        );
    const Trajectory& trajectory = objects.front();
    const auto collected = collect_position_samples(trajectory, kFewest);
    if (!collected) return tl::unexpected(collected.error());
    const std::span<const PositionSample> samples = *collected;
    const double length = conditions.metric ? 1.0 : std::max(extent_of(samples), 1e-9);
    const auto roll = find_roll(samples);
    if (!roll) return tl::unexpected(roll.error());
    const double t0 = samples[roll->stretch.samples.begin].t;
    const auto fit_to = [&](const Stretch& s, const PathModel& model, double from) {
        return fit_path(
            samples.subspan(s.begin, s.size()), model, start_at(*roll, from - t0, length)
        );
    };
    const auto model_from = [](double from) -> PathModel {
        return [from](const VectorXd& x, std::span<const double> t, std::span<Vector3d> p) {
            incline_path(x, from, t, p);
        };
    };
    const PathModel rough = model_from(t0);
    const auto predict = [&](const Stretch& s, std::span<const PositionSample> at) {
        const auto fit = fit_to(s, rough, t0);
        std::vector<Vector3d> p(fit ? at.size() : 0);
        std::vector<double> t;
        for (const auto& sample : at)
            t.push_back(sample.t);
        if (fit) rough(fit->parameters, t, p);
        return p;
    };
    Stretch stretch = grow_stretch(samples, roll->stretch.samples, predict, 5);
    stretch = without_ends(samples, stretch, kEndShare, 3);
    const double begin = samples[stretch.begin].t;
    const PathModel model = model_from(begin);
    const auto fit = fit_to(stretch, model, begin);
    if (!fit) return tl::unexpected(fit.error());

    AnalysisOutcome out;
    out.facts = stretch_facts(samples, stretch);
    measure(out, *fit, settings, conditions);
    for (auto& w : stretch_warnings(samples, stretch, *fit, "a free roll", conditions.metric))
        out.warnings.push_back(std::move(w));
    out.fits.push_back(path_for_plots(trajectory, samples, stretch, model, *fit));
    const ObjectFit& plotted = out.fits.front();
    const Vector3d down = incline_direction(fit->parameters);
    const Vector3d origin = fit->parameters.head<3>();
    const double heading = fit->parameters[kInclineHeading];
    out.plots = {
        position_plot(plotted, origin, down, "position", "Way down the slope against time", "s"),
        residual_plot(plotted),
        path_plot(plotted, origin, {std::cos(heading), std::sin(heading), 0.0}, Vector3d::UnitZ()),
        velocity_plot(plotted, trajectory, down)};
    if (!conditions.metric) label_in_pixels(out.plots);
    return out;
}

}  // namespace

AnalysisMethod incline_method() {
    AnalysisMethod method;
    method.name = "incline";
    method.settings = {
        {"incline_deg",
         0.1,
         80.0,
         {},
         "The plank's angle to the horizontal, from a plane fit; without it the path's own."},
        {"incline_u_deg", 0.0, 45.0, 0.5, "Standard uncertainty of incline_deg."},
        {"ball_radius_m", 0.0, 1.0, 0.0, "Counts where the ball rolls in a groove."},
        {"groove_width_m",
         0.0,
         1.0,
         0.0,
         "Between the two edges that carry the ball; 0 = a plank."},
        {"rolling_resistance",
         0.0,
         0.2,
         {},
         "Coefficient; without it 0 ± 0.001, a line in the budget."},
        {"latitude_deg",
         -90.0,
         90.0,
         {},
         "Of the rig, for the local g; without it 9.806 ± 0.015."}};
    method.results = {"acceleration", "angle", "g", "friction", "drag"};
    method.plots = {"position", "residuals", "path", "velocity"};
    method.facts = {
        "duration_s",
        "start_s",
        "gap_share",
        "rolling_probability",
        "path_angle_deg",
        "path_minus_plank_deg"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
