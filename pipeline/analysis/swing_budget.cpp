#include "pipeline/analysis/swing_budget.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/analysis/swing_measurements.hpp"

namespace kinectlab {
namespace {

double root(double square) {
    return std::sqrt(std::max(square, 0.0));
}

}  // namespace

SwingBudgets::SwingBudgets(const SwingFit& fit, const PendulumSettings& settings)
    : fit_(fit), settings_(settings), step_(SwingVector::Zero()) {
    for (int i = 0; i < kSwingParameters; ++i) {
        const double sigma = root(fit.from_noise.variance(i) + fit.from_tilt(i, i)) +
                             std::abs(fit.by_radius[i]) * 1e-6;
        if (sigma > 0.0) step_[i] = std::max(0.1 * sigma, 1e-7);
    }
}

Measurement SwingBudgets::measure(
    std::string name,
    std::string unit,
    const SwingFormula& formula,
    const SwingSensitivity& sensitivity
) const {
    const SwingParameters& p = fit_.parameters;
    SwingVector g = SwingVector::Zero();
    for (int i = 0; i < kSwingParameters; ++i) {
        if (step_[i] == 0.0) continue;
        SwingVector step = SwingVector::Zero();
        step[i] = step_[i];
        g[i] = (formula(moved(p, step)) - formula(moved(p, -step))) / (2.0 * step_[i]);
    }
    const double by_radius = g.dot(fit_.by_radius);
    const bool known = settings_.length_m && settings_.metric;
    const double scale =
        known ? sensitivity.scale + by_radius * *settings_.length_m : sensitivity.scale;
    const double length = known ? sensitivity.length + by_radius : sensitivity.length;
    const double assumed = known ? 0.0 : by_radius * swing_priors(settings_, p.radius).radius_sigma;
    Measurement m{std::move(name), formula(p), 0.0, std::move(unit), {}};
    double others = sensitivity.other_drag * sensitivity.other_drag;
    if (sensitivity.any_drag)
        for (const auto& model : fit_.drag.models)
            others += model.weight * std::pow(formula(model.parameters) - m.value, 2);
    m.budget = {
        {"statistics", root(fit_.from_noise.variance(g) + assumed * assumed)},
        {"camera tilt", root(g.dot(fit_.from_tilt * g))},
        {"length", settings_.length_m ? std::abs(length) * settings_.length_u_m : 0.0},
        {"clock", std::abs(sensitivity.clock) * settings_.clock_u},
        {"depth scale", settings_.metric ? std::abs(scale) * settings_.depth_scale_u : 0.0},
        {"model choice", std::sqrt(others)},
    };
    m.u = combined(m.budget);
    return m;
}

}  // namespace kinectlab
