#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"
#include "pipeline/analysis/path_report.hpp"
#include "pipeline/analysis/path_stretch.hpp"
#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/analysis/projectile_measurements.hpp"
#include "pipeline/analysis/projectile_model.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kFewest = 8;     // positions of a flight
constexpr double kShortest = 0.15;     // s
constexpr double kSlanted = 0.2;       // share of the fall's acceleration that may lie across
constexpr double kDragUnknown = 0.05;  // 1/m: between a steel ball and one for table tennis
constexpr double kSphereDrag = 0.47;   // coefficient of a smooth ball, Re 1e3 to 1e5 ...
constexpr double kSphereDragU = 0.05;  // ... and how well that holds
constexpr double kEndShare = 0.03;
constexpr double kLongestUnseen = 0.5;   // s of a flight before its first picture
constexpr std::size_t kSeenResting = 3;  // positions before a flight that began after the release

Air air_of(const AnalysisSettings& s, double length) {
    const double rho = s.at("air_density_kg_m3");
    if (rho == 0.0) return {0.0, 0.0, 0.0, true};
    Air air;
    air.drag_u = kDragUnknown / length;
    if (!s.contains("ball_density_kg_m3")) return air;
    air.density_ratio = rho / s.at("ball_density_kg_m3");
    if (!s.contains("ball_radius_m")) return air;
    const bool known = s.contains("drag_coefficient");
    const double coefficient = known ? s.at("drag_coefficient") : kSphereDrag;
    const double u = known ? s.at("drag_coefficient_u") : kSphereDragU;
    const double by =
        3.0 / 8.0 * *air.density_ratio / s.at("ball_radius_m") / (1.0 + *air.density_ratio / 2.0);
    air.drag = coefficient * by;
    air.drag_u = u * by;
    air.drag_given = true;
    return air;
}

bool falls(const ParabolaStretch& s, std::span<const PositionSample> samples, bool on_earth) {
    const double t = samples[s.samples.end - 1].t - samples[s.samples.begin].t;
    if (s.samples.size() < kFewest || t < kShortest || -s.a.z() < 5.0 * s.u_a.z()) return false;
    const double across = s.a.head<2>().norm();
    if (across > kSlanted * -s.a.z() + 3.0 * s.u_a.head<2>().norm()) return false;
    return !on_earth || (-s.a.z() > 4.0 && -s.a.z() < 14.0);
}

struct Found {
    ParabolaStretch flight;
    std::vector<Stretch> flights;
};

Result<Found> find_flight(std::span<const PositionSample> samples, bool on_earth) {
    const auto stretches = parabola_stretches(samples);
    Found found;
    double best = 0.0;
    for (const auto& s : stretches) {
        if (!falls(s, samples, on_earth)) continue;
        found.flights.push_back(s.samples);
        const double t = samples[s.samples.end - 1].t - samples[s.samples.begin].t;
        if (const double arc = -s.a.z() * t * t; arc > best) {
            best = arc;
            found.flight = s;
        }
    }
    if (!found.flights.empty()) return found;
    double strongest = 0.0;
    for (const auto& s : stretches)
        if (s.samples.size() >= kFewest && s.a.norm() > 5.0 * s.u_a.norm())
            strongest = std::max(strongest, -s.a.z());
    const std::string seen =
        on_earth ? fmt::format("; the strongest pull downwards is {:.2f} m/s²", strongest) : "";
    return fail(
        ErrorCode::bad_data,
        "samples",
        "no free flight is in the recording" + seen,
        fmt::format(
            "throw or drop the ball so that at least {} positions and {} s of its flight are seen, "
            "and see that the scale and the lab's vertical are right",
            kFewest,
            kShortest
        )
    );
}

std::vector<PathParameter> start_at(
    const ParabolaStretch& s, const Air& air, double tilt_u, double length
) {
    std::vector<PathParameter> all(kFlightParameters);
    for (int k = 0; k < 3; ++k) {
        all[static_cast<std::size_t>(kFlightX + k)] = {s.p[k], 0.01 * length, 0.0, -1};
        all[static_cast<std::size_t>(kFlightVx + k)] = {s.v[k], 0.1 * length, 0.0, -1};
    }
    all[kFlightG] = {-s.a.z(), length, 0.0, -1};
    all[kFlightTiltX] = {0.0, 0.02, 0.0, tilt_u};
    all[kFlightTiltY] = {0.0, 0.02, 0.0, tilt_u};
    all[kFlightDrag] = {air.drag, kDragUnknown / length, air.drag, air.drag_u};
    return all;
}

void warn(AnalysisOutcome& out, const PathFit& fit, const AnalysisConditions& conditions) {
    const VectorXd& x = fit.parameters;
    const double lean = std::hypot(x[kFlightTiltX], x[kFlightTiltY]);
    if (lean > 3.0 * conditions.tilt_u_rad)
        out.warnings.push_back(fmt::format(
            "It falls {:.1f}° off the lab's vertical; is the camera's place set right?",
            lean * 180.0 / M_PI
        ));
    if (!conditions.metric) {
        out.notes.emplace_back(
            "The positions are in pixels of unknown size: g, speeds and heights are left out."
        );
        return;
    }
    const Measurement& g = out.measurements.front();
    if (conditions.on_earth && !is_earthly(g.value, 4.0 * g.u))
        out.warnings.push_back(fmt::format(
            "g = {:.3f} m/s² is not found on the Earth's ground ({} to {} m/s²); are scale and "
            "clock right, and was it a ball without spin?",
            g.value,
            kLeastOnEarth,
            kMostOnEarth
        ));
}

/// When the flight began: at the release, although its first pictures may be missing; where the
/// ball was seen before it flew, with the first position of the flight.
double start_of(
    const Trajectory& trajectory,
    std::span<const PositionSample> samples,
    const Stretch& flight,
    const AnalysisConditions& conditions
) {
    const double first_seen = samples[flight.begin].t;
    if (!conditions.released || flight.begin >= kSeenResting) return first_seen;
    const double released =
        static_cast<double>(*conditions.released - trajectory.samples.front().t) /
        static_cast<double>(kNsPerSecond);
    const double unseen = first_seen - released;
    return unseen >= 0.0 && unseen < kLongestUnseen ? released : first_seen;
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    const Trajectory& trajectory = objects.front();
    const auto collected = collect_position_samples(trajectory, kFewest);
    if (!collected) return tl::unexpected(collected.error());
    const std::span<const PositionSample> samples = *collected;
    const double length = conditions.metric ? 1.0 : std::max(extent_of(samples), 1e-9);
    const auto found = find_flight(samples, conditions.on_earth && conditions.metric);
    if (!found) return tl::unexpected(found.error());
    const Air air = air_of(settings, length);
    const auto start = start_at(found->flight, air, conditions.tilt_u_rad, length);
    const double t0 = samples[found->flight.samples.begin].t;
    const auto model_from = [](double from) -> PathModel {
        return [from](const VectorXd& x, std::span<const double> t, std::span<Vector3d> p) {
            projectile_path(x, from, t, p);
        };
    };
    const PathModel rough = model_from(t0);
    const auto predict = [&](const Stretch& s, std::span<const PositionSample> at) {
        const auto fit = fit_path(samples.subspan(s.begin, s.size()), rough, start);
        std::vector<Vector3d> p(fit ? at.size() : 0);
        std::vector<double> t;
        for (const auto& sample : at)
            t.push_back(sample.t);
        if (fit) rough(fit->parameters, t, p);
        return p;
    };
    Stretch stretch = grow_stretch(samples, found->flight.samples, predict, 4);
    stretch = without_ends(samples, stretch, kEndShare, 2);
    const double begin = start_of(trajectory, samples, stretch, conditions);
    auto moved = found->flight;
    moved.p += (begin - t0) * (moved.v + (begin - t0) / 2 * moved.a);
    moved.v += (begin - t0) * moved.a;
    const PathModel model = model_from(begin);
    const auto fit = fit_path(
        samples.subspan(stretch.begin, stretch.size()),
        model,
        start_at(moved, air, conditions.tilt_u_rad, length)
    );
    if (!fit) return tl::unexpected(fit.error());

    AnalysisOutcome out;
    out.facts = stretch_facts(samples, stretch);
    const auto others =
        std::count_if(found->flights.begin(), found->flights.end(), [&](const Stretch& s) {
            return s.end <= stretch.begin + 2 || s.begin + 2 >= stretch.end;
        });
    out.facts["flights"] = static_cast<double>(others + 1);
    const double unseen = samples[stretch.begin].t - begin;
    measure_projectile(
        out,
        *fit,
        air,
        out.facts["duration_s"] + unseen,
        begin != samples[stretch.begin].t,
        conditions
    );
    out.warnings = stretch_warnings(samples, stretch, *fit, "a free flight", conditions.metric);
    warn(out, *fit, conditions);
    if (others > 0)
        out.notes.push_back(fmt::format(
            "{} flights were seen; the one that falls farthest was measured.", others + 1
        ));
    out.fits.push_back(path_for_plots(trajectory, samples, stretch, model, *fit));
    const Vector3d origin = fit->parameters.segment<3>(kFlightX);
    Vector3d right = flight_velocity(fit->parameters);
    right.z() = 0.0;
    if (right.norm() < 1e-6 * length) right = Vector3d::UnitX();
    right.normalize();
    const ObjectFit& plotted = out.fits.front();
    out.plots = {
        position_plot(plotted, origin, Vector3d::UnitZ(), "position", "Height against time", "z"),
        residual_plot(plotted),
        path_plot(plotted, origin, right, Vector3d::UnitZ()),
        velocity_plot(plotted, trajectory, Vector3d::Zero())};
    if (!conditions.metric) label_in_pixels(out.plots);
    return out;
}

}  // namespace

AnalysisMethod projectile_method() {
    AnalysisMethod method;
    method.name = "projectile";
    method.settings = {
        {"ball_density_kg_m3",
         10.0,
         25000.0,
         {},
         "For buoyancy and drag; without it they are lines in the budget."},
        {"ball_radius_m", 0.001, 1.0, {}, "For the drag; without it the data or the budget tell."},
        {"air_density_kg_m3", 0.0, 10.0, 1.2, "Of the air around; 0 is a vacuum."},
        {"drag_coefficient", 0.0, 3.0, {}, "Of the ball; without it 0.47 ± 0.05, a smooth sphere."},
        {"drag_coefficient_u", 0.001, 3.0, 0.05, "Standard uncertainty of drag_coefficient."}};
    method.results = {"g", "launch_speed", "elevation", "drag", "rise", "time_to_top"};
    method.plots = {"position", "residuals", "path", "velocity"};
    method.facts = {"duration_s", "start_s", "gap_share", "flights"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
