#include "pipeline/analysis/swing_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "pipeline/analysis/free_swing.hpp"
#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

constexpr double kOutlier = 4.5;  // sigma in three dimensions: one sample in 7,000 of pure noise
constexpr double kFewestPeriods = 3.0;
constexpr double kSteepest = 80.0 * std::numbers::pi / 180.0;
constexpr double kMedianChi2 = 2.366;  // of three degrees of freedom
constexpr double kSmallestNoise =
    1e-6;  // share of the given variance below which residuals are rounding

using Samples = std::span<const PositionSample>;
using Residuals = std::vector<Eigen::Vector3d>;

std::vector<double> distances(
    Samples samples, const Residuals& residuals, const Eigen::Matrix3d& rescale
) {
    std::vector<double> d(samples.size());
    for (std::size_t i = 0; i < d.size(); ++i)
        d[i] = (rescale * samples[i].whiten * residuals[i]).norm();
    return d;
}

/// By how much the residuals exceed the samples' own sigma.
double noise_factor(Samples samples, const Residuals& residuals) {
    const double m = median(distances(samples, residuals, Eigen::Matrix3d::Identity()));
    return std::max(m / std::sqrt(kMedianChi2), std::sqrt(kSmallestNoise));
}

SwingWeights robust_weights(double factor) {
    return {Eigen::Matrix3d::Identity() / factor, 3.0, {}};
}

/// Makes the used residuals white on average, whatever the given covariances say of their shape;
/// the median of all sets the size if that is larger, so that nothing shrinks what counts as an
/// outlier.
Eigen::Matrix3d whiten_residuals(
    Samples samples, const Residuals& residuals, const std::vector<bool>& use
) {
    Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
    double n = -static_cast<double>(kSwingParameters) / 3.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!use[i]) continue;
        const Eigen::Vector3d r = samples[i].whiten * residuals[i];
        s += r * r.transpose();
        n += 1.0;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(s / n);
    const Eigen::Vector3d inverse_root =
        eigen.eigenvalues().cwiseMax(kSmallestNoise).cwiseSqrt().cwiseInverse();
    const Eigen::Matrix3d whiten =
        eigen.eigenvectors() * inverse_root.asDiagonal() * eigen.eigenvectors().transpose();
    const double size = median(distances(samples, residuals, whiten)) / std::sqrt(kMedianChi2);
    return whiten / std::max(size, 1.0);
}

std::vector<bool> within(const std::vector<double>& d, double limit) {
    std::vector<bool> use(d.size());
    std::transform(d.begin(), d.end(), use.begin(), [&](double x) { return x <= limit; });
    return use;
}

struct ScoreCovariance {
    SwingMatrix independent;  ///< each sample with its own noise (White 1980)
    SwingMatrix correlated;   ///< and with its neighbours' (Newey and West 1987)
};

/// Sum of the products of the scores: of each sample with itself, and at all lags up to a quarter
/// period, Bartlett-weighted.
ScoreCovariance score_covariance(
    Samples samples,
    const Residuals& residuals,
    const SwingParameters& parameters,
    const SwingWeights& weights,
    double period
) {
    std::vector<SwingVector> scores;
    SwingPath path(parameters);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!weights.use[i]) continue;
        path.go_to(samples[i].t - samples.front().t);
        const Eigen::Matrix3d whiten = weights.rescale * samples[i].whiten;
        scores.emplace_back((whiten * path.jacobian()).transpose() * (whiten * residuals[i]));
    }
    const double step =
        (samples.back().t - samples.front().t) / static_cast<double>(samples.size());
    const int lags = std::max(3, static_cast<int>(period / 4.0 / step));
    ScoreCovariance sum{SwingMatrix::Zero(), SwingMatrix::Zero()};
    for (std::size_t i = 0; i < scores.size(); ++i) {
        SwingVector before = SwingVector::Zero();
        for (int lag = 1; lag <= lags && static_cast<std::size_t>(lag) <= i; ++lag)
            before += (1.0 - lag / (lags + 1.0)) * scores[i - static_cast<std::size_t>(lag)];
        sum.independent.noalias() += scores[i] * scores[i].transpose();
        sum.correlated.noalias() += scores[i] * before.transpose();
    }
    sum.correlated = sum.independent + sum.correlated + sum.correlated.transpose().eval();
    return sum;
}

/// The covariance that the samples' own noise makes, each parameter widened by what correlation in
/// time adds to it.
SwingMatrix widened(const SwingMatrix& independent, const SwingMatrix& correlated) {
    SwingVector factor = SwingVector::Ones();
    for (int i = 0; i < kSwingParameters; ++i)
        if (independent(i, i) > 0.0)
            factor[i] = std::sqrt(std::max(1.0, correlated(i, i) / independent(i, i)));
    return factor.asDiagonal() * independent * factor.asDiagonal();
}

Result<SwingParameters> follow_free_swing(
    Samples samples, const SwingGuess& guess, const SwingPriors& priors, FreeSwing& range
) {
    SwingParameters parameters = guess.parameters;
    range = {guess.begin, guess.end, false, false};
    double noise = 0.0;
    for (bool whole = false;; whole = range.begin_found && range.end_found) {
        const Samples known = samples.subspan(range.begin, range.end - range.begin);
        const double periods = (known.back().t - known.front().t) / guess.period;
        if (whole && periods < kFewestPeriods - 0.1)
            return fail(
                ErrorCode::bad_data,
                "samples",
                fmt::format("only {:.1f} periods of free swing were found", periods),
                "let the pendulum swing freely for at least three periods, ten or more for a good "
                "result"
            );
        if (noise == 0.0) noise = noise_factor(known, swing_residuals(known, parameters));
        parameters = minimise(known, parameters, robust_weights(noise), priors, 0.3);
        if (whole) return parameters;

        const Residuals residuals = swing_residuals(known, parameters);
        noise = noise_factor(known, residuals);
        std::vector<double> off;
        for (const auto& r : residuals)
            off.push_back(r.norm());
        const double amplitude =
            parameters.radius * std::sin(std::min(turning_angle(parameters), 1.5));
        if (noise > 3.0 && !(median(std::move(off)) < 0.25 * amplitude))
            return fail(
                ErrorCode::bad_data,
                "samples",
                kAnotherMotion,
                "check length_m, and let the pendulum swing freely for at least three periods"
            );
        const PathTolerance tolerance{6.0 * noise, 0.1 * amplitude};
        const FreeSwing grown =
            grow_free_swing(samples, range, parameters, guess.period, tolerance);
        SwingPath path(parameters);
        path.go_to(samples[grown.begin].t - samples[range.begin].t);
        parameters = path.now();
        range = grown;
    }
}

}  // namespace

double turning_angle(const SwingParameters& p) {
    // cos θ = c at a turning point: 2 (E + w² c)(1 - c²) = l², with the energy E and l along the
    // plumb line.
    const double c0 = p.n.dot(p.down());
    const double energy = 0.5 * p.v.squaredNorm() - p.omega0_sq * c0;
    const double l2 = std::pow(p.n.cross(p.v).dot(p.down()), 2);
    const auto f = [&](double c) {
        return 2.0 * (energy + p.omega0_sq * c) * (1.0 - c * c) - l2;
    };
    double low = -1.0;  // f < 0 here, and f >= 0 where the bob is
    double high = c0;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2.0;
        (f(middle) < 0.0 ? low : high) = middle;
    }
    return std::acos(std::clamp(high, -1.0, 1.0));
}

double energy_angle(const SwingParameters& p) {
    const double c = p.n.dot(p.down()) - 0.5 * p.v.squaredNorm() / p.omega0_sq;
    return std::acos(std::clamp(c, -1.0, 1.0));
}

Result<SwingFit> fit_swing(
    std::span<const PositionSample> all, const SwingGuess& guess, const SwingPriors& priors
) {
    FreeSwing range;
    auto followed = follow_free_swing(all, guess, priors, range);
    if (!followed) return tl::unexpected(followed.error());

    SwingFit fit;
    fit.parameters = *followed;
    fit.begin = range.begin;
    fit.end = range.end;
    const Samples samples = all.subspan(fit.begin, fit.end - fit.begin);
    fit.residuals = swing_residuals(samples, fit.parameters);
    const double factor = noise_factor(samples, fit.residuals);
    SwingWeights weights{
        Eigen::Matrix3d::Identity() / factor, std::numeric_limits<double>::infinity(), {}};
    for (int round = 0; round < 4; ++round) {
        if (round > 0) weights.rescale = whiten_residuals(samples, fit.residuals, weights.use);
        auto use = within(distances(samples, fit.residuals, weights.rescale), kOutlier);
        if (round > 1 && use == weights.use) break;
        weights.use = std::move(use);
        weights.rescale = whiten_residuals(samples, fit.residuals, weights.use);
        fit.parameters = minimise(samples, fit.parameters, weights, priors);
        fit.residuals = swing_residuals(samples, fit.parameters);
    }
    fit.used = weights.use;
    if (turning_angle(fit.parameters) > kSteepest)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format(
                "the amplitude is {:.0f}°, beyond 80°",
                turning_angle(fit.parameters) * 180.0 / std::numbers::pi
            ),
            "release the pendulum from a smaller angle, or correct length_m"
        );

    const NormalEquations at_best = linearise(samples, fit.parameters, weights);
    const SwingMatrix prior = prior_information(priors);
    const ScoreCovariance scores =
        score_covariance(samples, fit.residuals, fit.parameters, weights, guess.period);
    const SwingMatrix c = inverse_information(at_best.information + prior, 1);
    SwingMatrix tilt_prior = prior;
    tilt_prior(kRadius, kRadius) = 0.0;
    fit.from_noise = widened(c * scores.independent * c, c * scores.correlated * c);
    fit.from_tilt = c * tilt_prior * c;
    fit.by_radius = c.col(kRadius) * prior(kRadius, kRadius);

    // One more step without the radius' prior, and one with the Earth's turning set free.
    const auto one_free =
        [&](const SwingMatrix& known, int fixed, int index, double& step, double& u) {
            const SwingMatrix inverse = inverse_information(at_best.information + known, fixed);
            const SwingVector gradient =
                at_best.gradient + known * prior_offset(fit.parameters, priors);
            step = (inverse * gradient)[index];
            u = std::sqrt(
                widened(
                    inverse * scores.independent * inverse, inverse * scores.correlated * inverse
                )(index, index) +
                (inverse * known * inverse)(index, index)
            );
        };
    double step = 0.0;
    one_free(tilt_prior, 1, kRadius, step, fit.free_radius_u);
    fit.free_radius = fit.parameters.radius + step;
    one_free(prior, 0, kTurning, step, fit.free_turning_u);
    fit.free_turning = fit.parameters.turning + step;

    double chi2 = 0.0;
    double n = 0.0;
    const auto own = distances(samples, fit.residuals, Eigen::Matrix3d::Identity());
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (!fit.used[i]) continue;
        chi2 += own[i] * own[i];
        n += 3.0;
    }
    fit.reduced_chi2 = chi2 / (n - (kSwingParameters - 1));
    return fit;
}

}  // namespace kinectlab
