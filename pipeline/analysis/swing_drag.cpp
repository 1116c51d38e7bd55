#include "pipeline/analysis/swing_drag.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kinectlab {
namespace {

constexpr double kStrong = 6.0;  // of Schwarz's criterion

double sum_of_squares(
    std::span<const PositionSample> samples,
    const SwingParameters& parameters,
    const SwingWeights& weights,
    const SwingPriors& priors
) {
    const SwingVector offset = prior_offset(parameters, priors);
    return 2.0 * linearise(samples, parameters, weights).cost +
           offset.dot(prior_information(priors) * offset);
}

/// One kind of drag in place of both, about as strong at this speed.
SwingParameters with_one(SwingParameters p, DragLaw law, double speed) {
    if (law == DragLaw::linear) p.damping += 0.5 * p.quadratic * speed;
    if (law == DragLaw::quadratic) p.quadratic += 2.0 * p.damping / speed;
    (law == DragLaw::linear ? p.quadratic : p.damping) = 0.0;
    return p;
}

}  // namespace

SwingMask drag_mask(SwingMask base, DragLaw law) {
    base[kDamping] = law != DragLaw::quadratic;
    base[kQuadratic] = law != DragLaw::linear;
    return base;
}

DragChoice choose_drag(
    std::span<const PositionSample> samples,
    const SwingParameters& start,
    const SwingWeights& weights,
    const SwingPriors& priors,
    const SwingMask& base,
    double widening
) {
    const double amplitude =
        std::hypot(start.n.cross(start.down()).norm(), start.v.norm() / std::sqrt(start.omega0_sq));
    const double speed =
        8.0 / (3.0 * std::numbers::pi) * std::sqrt(start.omega0_sq) * std::max(amplitude, 1e-6);
    const auto fitted = [&](DragLaw law) {
        return minimise(
            samples, with_one(start, law, speed), weights, priors, drag_mask(base, law)
        );
    };
    const SwingParameters linear = fitted(DragLaw::linear);
    const SwingParameters quadratic = fitted(DragLaw::quadratic);
    const double squares = sum_of_squares(samples, start, weights, priors);
    const auto f_without = [&](const SwingParameters& p) {
        return std::max(0.0, (sum_of_squares(samples, p, weights, priors) - squares) / widening);
    };
    DragChoice choice;
    choice.f_quadratic = f_without(linear);
    choice.f_linear = f_without(quadratic);
    const double n =
        3.0 * static_cast<double>(std::count(weights.use.begin(), weights.use.end(), true));
    const double penalty = std::log(n / widening);  // of one more parameter

    struct Candidate {
        DragModel model;
        double criterion;
    };
    std::vector<Candidate> all{{{DragLaw::linear, linear}, choice.f_quadratic}};
    if (quadratic.quadratic > 0.0 && linear.damping > 0.0)
        all.push_back({{DragLaw::quadratic, quadratic}, choice.f_linear});
    if (start.quadratic > 0.0 && start.damping > 0.0)
        all.push_back({{DragLaw::both, start}, penalty});
    const Candidate* best = &all.front();
    for (const auto& candidate : all)
        if (candidate.criterion <
            best->criterion - (candidate.model.law == DragLaw::quadratic ? kStrong : 0.0))
            best = &candidate;
    const bool both_admissible = all.back().model.law == DragLaw::both;
    if (best->model.law == DragLaw::quadratic && both_admissible) {
        choice.law = DragLaw::both;
        choice.parameters = start;
        choice.models = {{DragLaw::both, start, 1.0}};
        choice.told_apart = true;
        return choice;
    }
    choice.law = best->model.law;
    choice.linear_seen = choice.law == DragLaw::both;
    choice.parameters = best->model.parameters;
    choice.told_apart = true;
    double sum = 0.0;
    for (const auto& candidate : all) {
        const double behind = candidate.criterion - best->criterion;
        const bool rival = &candidate != best && candidate.model.law != DragLaw::both;
        if (rival && behind < kStrong && choice.law != DragLaw::both) choice.told_apart = false;
        choice.models.push_back(candidate.model);
        choice.models.back().weight = std::exp(-std::max(behind, -kStrong) / 2.0);
        sum += choice.models.back().weight;
    }
    for (auto& model : choice.models)
        model.weight /= sum;
    return choice;
}

double rms_if_positive(double value, double u) {
    if (!(u > 0.0)) return std::max(value, 0.0);
    // Of the normal distribution cut off at zero.
    const double a = value / u;
    const double density = std::exp(-a * a / 2.0) / std::sqrt(2.0 * std::numbers::pi);
    const double share = std::max(std::erfc(-a / std::numbers::sqrt2) / 2.0, 1e-12);
    return u * std::sqrt(std::max(1.0 + a * a + a * density / share, 0.0));
}

}  // namespace kinectlab
