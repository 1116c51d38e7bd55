#include "pipeline/analysis/least_squares.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace kinectlab {
namespace {

constexpr int kMostSteps = 40;
constexpr double kStrongestDrag = 10.0;  // 1/rad: a swing of 10° would be over at once

/// Cost and, where asked for, its derivatives.
NormalEquations evaluate(
    std::span<const PositionSample> samples,
    const SwingParameters& parameters,
    const SwingWeights& weights
) {
    NormalEquations sum;
    SwingPath path(parameters);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!weights.use.empty() && !weights.use[i]) continue;
        path.go_to(samples[i].t - samples.front().t);
        const Eigen::Matrix3d whiten = weights.rescale * samples[i].whiten;
        const Eigen::Vector3d r = whiten * (samples[i].p_lab - path.position());
        const double d = r.norm();
        const bool far = d > weights.huber;
        sum.cost += far ? weights.huber * (d - weights.huber / 2) : d * d / 2;
        const double weight = far ? weights.huber / d : 1.0;
        const SwingJacobian j = whiten.lazyProduct(path.jacobian());
        sum.information += j.transpose().lazyProduct(weight * j);  // lazy: too small for blocks
        sum.gradient.noalias() += weight * j.transpose() * r;
    }
    return sum;
}

bool plausible(const SwingParameters& p) {
    return p.omega0_sq > 0.0 && p.radius > 0.0 && std::abs(p.damping) < std::sqrt(p.omega0_sq) &&
           std::abs(p.quadratic) < kStrongestDrag && p.tilt.norm() < 1.0;
}

}  // namespace

std::vector<Eigen::Vector3d> swing_residuals(
    std::span<const PositionSample> samples, const SwingParameters& parameters
) {
    std::vector<Eigen::Vector3d> residuals;
    residuals.reserve(samples.size());
    SwingPath path(parameters);
    for (const auto& sample : samples) {
        path.go_to(sample.t - samples.front().t);
        residuals.emplace_back(sample.p_lab - path.position());
    }
    return residuals;
}

NormalEquations linearise(
    std::span<const PositionSample> samples,
    const SwingParameters& parameters,
    const SwingWeights& weights
) {
    return evaluate(samples, parameters, weights);
}

SwingMatrix prior_information(const SwingPriors& priors) {
    SwingMatrix information = SwingMatrix::Zero();
    information(kRadius, kRadius) = std::pow(std::max(priors.radius_sigma, 1e-9), -2);
    information(kTilt, kTilt) = information(kTilt + 1, kTilt + 1) = std::pow(priors.tilt_sigma, -2);
    return information;
}

SwingVector prior_offset(const SwingParameters& p, const SwingPriors& priors) {
    SwingVector offset = SwingVector::Zero();
    offset[kRadius] = priors.radius - p.radius;
    offset.segment<2>(kTilt) = -p.tilt;
    return offset;
}

SwingMatrix inverse_information(const SwingMatrix& information, const SwingMask& free) {
    std::vector<int> at;
    for (int i = 0; i < kSwingParameters; ++i)
        if (free[static_cast<std::size_t>(i)]) at.push_back(i);
    const Eigen::MatrixXd some = information(at, at);
    const Eigen::VectorXd scale = some.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * some * scale.asDiagonal();
    SwingMatrix inverse = SwingMatrix::Zero();
    inverse(at, at) = scale.asDiagonal() *
                      scaled.ldlt().solve(Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols())) *
                      scale.asDiagonal();
    return inverse;
}

SwingParameters minimise(
    std::span<const PositionSample> samples,
    SwingParameters start,
    const SwingWeights& weights,
    const SwingPriors& priors,
    const SwingMask& free,
    double tolerance
) {
    const SwingMatrix prior = prior_information(priors);
    const auto prior_cost = [&](const SwingParameters& p) {
        const SwingVector offset = prior_offset(p, priors);
        return 0.5 * offset.dot(prior * offset);
    };
    SwingParameters best = start;
    NormalEquations here = evaluate(samples, best, weights);
    double cost = here.cost + prior_cost(best);
    double lambda = 1e-3;
    for (int step = 0; step < kMostSteps; ++step) {
        SwingMatrix damped = here.information + prior;
        damped.diagonal() *= 1.0 + lambda;
        const SwingVector change = inverse_information(damped, free) *
                                   (here.gradient + prior * prior_offset(best, priors));
        const SwingParameters trial = moved(best, change);
        const double predicted = change.dot(damped * change);  // no change where it is not free
        if (plausible(trial)) {
            NormalEquations there = evaluate(samples, trial, weights);
            const double trial_cost = there.cost + prior_cost(trial);
            if (trial_cost <= cost || predicted < 1e-8 * (1.0 + 1e-6 * cost)) {
                best = trial;
                here = there;
                cost = trial_cost;
                lambda = std::max(lambda / 10.0, 1e-12);
                if (predicted < tolerance * tolerance) break;
                continue;
            }
        }
        lambda *= 10.0;
        if (lambda > 1e12) break;
    }
    return best;
}

}  // namespace kinectlab
