#include "pipeline/analysis/mean_motion.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "pipeline/analysis/fit_budget.hpp"
#include "pipeline/analysis/position_samples.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr const char* kAxes[] = {"x", "y", "z"};

Vector3d parabola(const VectorXd& p, double t) {
    return p.segment<3>(0) + t * p.segment<3>(3) + 0.5 * t * t * p.segment<3>(6);
}

}  // namespace

Result<void> add_mean_motion(
    const Trajectory& object, const AnalysisConditions& conditions, AnalysisOutcome& outcome
) {
    const auto samples = collect_position_samples(object, 12);
    if (!samples) return tl::unexpected(samples.error());
    const double half = 0.5 * (samples->back().t - samples->front().t);
    const double middle = samples->front().t + half;
    std::vector<ResidualPlace> places;
    for (const auto& s : *samples)
        places.push_back({0, s.t - middle});
    std::vector<PathParameter> parameters(9);
    const Vector3d start = (*samples)[samples->size() / 2].p_lab;
    for (std::size_t i = 0; i < 9; ++i)
        parameters[i] = {i < 3 ? start[static_cast<Eigen::Index>(i)] : 0.0, 0.01, 0.0, -1.0};
    const ResidualModel model = [&](const VectorXd& p, std::span<Vector3d> r) {
        for (std::size_t i = 0; i < r.size(); ++i)
            r[i] = (*samples)[i].whiten * ((*samples)[i].p_lab - parabola(p, places[i].t));
    };
    const auto fit = fit_residuals(places, model, parameters);
    if (!fit) return tl::unexpected(fit.error());

    ObjectFit plot =
        plotted_fit(object, [&](double t) { return parabola(fit->parameters, t - middle); });
    plot.outliers = fit->outliers;
    plot.used = static_cast<int>(samples->size()) - fit->outliers;
    plot.reduced_chi2 = fit->reduced_chi2;
    outcome.fits.push_back(std::move(plot));
    if (!conditions.metric) {
        outcome.notes.emplace_back(
            "Positions are in pixels: the mean position and velocity are left out."
        );
        return {};
    }
    const std::vector<std::string> none(9);
    // Over the whole run the parabola's mean lies a third of its rise at the ends from its middle.
    const auto position = [&](const VectorXd& p, int axis) {
        return p[axis] + half * half / 6.0 * p[6 + axis];
    };
    const auto velocity = [](const VectorXd& p, int axis) {
        return p[3 + axis];
    };
    const auto vector = [&](const auto& number) {
        return Vector3d(
            number(fit->parameters, 0), number(fit->parameters, 1), number(fit->parameters, 2)
        );
    };
    const auto add = [&](const char* name, const char* unit, const auto& number, double clock) {
        const Vector3d value = vector(number);
        const double up = std::abs(value.z()) * conditions.tilt_u_rad;
        const double tilt[] = {up, up, value.head<2>().norm() * conditions.tilt_u_rad};
        for (int axis = 0; axis < 3; ++axis)
            outcome.measurements.push_back(measure(
                std::string(name) + kAxes[axis],
                unit,
                [&](const VectorXd& p) { return number(p, axis); },
                *fit,
                none,
                {{"depth scale", std::abs(value[axis]) * conditions.depth_scale_u},
                 {"clock", std::abs(value[axis]) * clock * conditions.clock_u},
                 {"camera tilt", tilt[axis]}}
            ));
    };
    add("position_", "m", position, 0.0);
    add("velocity_", "m/s", velocity, 1.0);
    return {};
}

}  // namespace kinectlab
