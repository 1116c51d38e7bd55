#include "pipeline/analysis/projectile_measurements.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/analysis/path_budget.hpp"
#include "pipeline/analysis/projectile_model.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDensityUnknown = 1e-3;  // of air over the ball's: water's

double speed(const VectorXd& x) {
    return flight_velocity(x).norm();
}

double horizontal_speed(const VectorXd& x) {
    const Vector3d up = flight_up(x);
    return (flight_velocity(x) - flight_velocity(x).dot(up) * up).norm();
}

double elevation(const VectorXd& x) {
    return std::atan2(flight_velocity(x).dot(flight_up(x)), horizontal_speed(x));
}

}  // namespace

void measure_projectile(
    AnalysisOutcome& out,
    const PathFit& fit,
    const Air& air,
    double duration_s,
    bool from_release,
    const AnalysisConditions& conditions
) {
    const PathBudget budget(
        fit, {{"camera tilt", {kFlightTiltX, kFlightTiltY}}, {"drag", {kFlightDrag}}}, conditions
    );
    const bool metric = conditions.metric;
    const VectorXd& x = fit.parameters;
    const double square = flight_velocity(x).squaredNorm();
    const double pull =
        -x[kFlightG] * flight_up(x).dot(flight_velocity(x)) / std::max(std::sqrt(square), 1e-6);
    const double turning = horizontal_speed(x) * x[kFlightG] / (std::max(square, 1e-12));
    const double release_u = from_release ? conditions.released_u_s : 0.0;
    const auto by_release = [release_u](double rate) {
        std::vector<BudgetLine> lines;
        if (release_u > 0.0) lines.push_back({"moment of release", std::abs(rate) * release_u});
        return lines;
    };
    if (metric) {
        const double ratio = air.density_ratio.value_or(0.0);
        const double lift = (1.0 + ratio / 2.0) / (1.0 - ratio);
        std::vector<BudgetLine> more;
        if (!air.density_ratio) {
            more.push_back({"buoyancy", 1.5 * kDensityUnknown * fit.parameters[kFlightG]});
            out.notes.emplace_back(
                "The ball's density was not given: the air's buoyancy, 0.15 % of g for a ball as "
                "dense as water, is not corrected but stands in the budget."
            );
        }
        out.measurements.push_back(budget.measure(
            "g", "m/s²", [=](const VectorXd& x) { return lift * x[kFlightG]; }, {1, -2}, more
        ));
        const Measurement v =
            budget.measure("launch_speed", "m/s", speed, {1, -1}, by_release(pull));
        if (v.value > 4.0 * v.u)
            out.measurements.push_back(v);
        else
            out.notes.push_back(fmt::format(
                "It was released from rest, to {:.0f} mm/s: there is no launch speed to tell.",
                1e3 * (v.value + v.u)
            ));
    }
    const Measurement across = budget.measure("", "", horizontal_speed, {1, -1});
    if (across.value > 5.0 * across.u)
        out.measurements.push_back(
            budget.measure("elevation", "rad", elevation, {}, by_release(turning))
        );
    else
        out.notes.emplace_back(
            "It flew straight up or down: the elevation angle is not told apart from 90°."
        );
    const Measurement drag =
        budget.measure("drag", "1/m", [](const VectorXd& x) { return x[kFlightDrag]; }, {-1, 0});
    const bool shown = drag.u < 0.5 * air.drag_u;
    if (metric && shown)
        out.measurements.push_back(drag);
    else if (air.drag_u > 0.0)
        out.notes.emplace_back(
            air.drag_given
                ? fmt::format(
                      "The drag does not show in this flight: {:.2g} ± {:.1g} for each metre was "
                      "taken, from the ball's size and density and a smooth sphere's coefficient "
                      "or the one given.",
                      air.drag,
                      air.drag_u
                  )
                : "The drag does not show in this flight and was not given; what it may be is the "
                  "line \"drag\". Give ball_density_kg_m3 and ball_radius_m, or throw farther."
        );
    const FlightTop top = flight_top(fit.parameters);
    const Measurement rising = budget.measure(
        "", "", [](const VectorXd& x) { return flight_velocity(x).dot(flight_up(x)); }, {1, -1}
    );
    if (rising.value < 5.0 * rising.u || top.time > duration_s) return;
    if (metric)
        out.measurements.push_back(budget.measure(
            "rise",
            "m",
            [](const VectorXd& x) { return flight_top(x).rise; },
            {1, 0},
            by_release(rising.value)
        ));
    out.measurements.push_back(budget.measure(
        "time_to_top",
        "s",
        [](const VectorXd& x) { return flight_top(x).time; },
        {0, 1},
        by_release(1.0)
    ));
}

}  // namespace kinectlab
