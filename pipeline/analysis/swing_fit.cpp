#include "pipeline/analysis/swing_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "pipeline/analysis/free_swing.hpp"
#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/swing_noise.hpp"

namespace kinectlab {
namespace {

constexpr double kOutlier = 4.5;  // sigma in three dimensions: one sample in 7,000 of pure noise
constexpr double kFewestPeriods = 3.0;
constexpr double kSteepest = 80.0 * std::numbers::pi / 180.0;
constexpr double kManyPeriods = 12.0;  // in which the drag shows more than one number

using Samples = std::span<const PositionSample>;
using Residuals = std::vector<Eigen::Vector3d>;

SwingWeights robust_weights(double factor) {
    return {Eigen::Matrix3d::Identity() / factor, 3.0, {}};
}

std::vector<bool> within(const std::vector<double>& d, double limit) {
    std::vector<bool> use(d.size());
    std::transform(d.begin(), d.end(), use.begin(), [&](double x) { return x <= limit; });
    return use;
}

Result<SwingParameters> follow_free_swing(
    Samples samples,
    const SwingGuess& guess,
    const SwingPriors& priors,
    const SwingMask& free,
    FreeSwing& range
) {
    SwingParameters parameters = guess.parameters;
    range = {guess.begin, guess.end, false, false};
    double noise = 0.0;
    double longest = 0.0;  // s, when both ends had been found
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
        const bool many = periods > kManyPeriods || whole || longest > 0.0;
        parameters = minimise(
            known,
            parameters,
            robust_weights(noise),
            priors,
            drag_mask(free, many ? DragLaw::both : DragLaw::linear),
            0.3
        );
        if (whole) {
            const double seconds = known.back().t - known.front().t;
            if (seconds < longest + guess.period / 4.0 ||
                (range.begin == 0 && range.end == samples.size()))
                return parameters;
            // An end that the fit to a part could not follow, as strong drag changes the swing, may
            // be followed by the longer one's.
            longest = seconds;
            range.begin_found = range.end_found = false;
        }

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
    std::span<const PositionSample> all,
    const SwingGuess& guess,
    const SwingPriors& priors,
    bool turning_free
) {
    SwingMask base;
    base.set();
    base[kTurning] = turning_free;
    FreeSwing range;
    auto followed = follow_free_swing(all, guess, priors, base, range);
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
        auto use = within(residual_distances(samples, fit.residuals, weights.rescale), kOutlier);
        if (round > 1 && use == weights.use) break;
        weights.use = std::move(use);
        weights.rescale = whiten_residuals(samples, fit.residuals, weights.use);
        fit.parameters = minimise(samples, fit.parameters, weights, priors, base);
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

    const SwingMatrix prior = prior_information(priors);
    SwingMatrix tilt_prior = prior;
    tilt_prior(kRadius, kRadius) = 0.0;
    {
        const SwingMatrix c = inverse_information(
            linearise(samples, fit.parameters, weights).information + prior, base
        );
        const NoiseCovariance noisy = noise_covariance(
            c, score_covariance(samples, fit.residuals, fit.parameters, weights, guess.period)
        );
        const double widening = std::max(
            {1.0,
             noisy.variance(kDamping) / c(kDamping, kDamping),
             noisy.variance(kQuadratic) / c(kQuadratic, kQuadratic)}
        );
        fit.drag = choose_drag(samples, fit.parameters, weights, priors, base, widening);
        if (fit.drag.law == DragLaw::quadratic)
            fit.drag.quadratic_u_by_linear =
                std::abs(c(kQuadratic, kDamping)) / c(kDamping, kDamping) *
                rms_if_positive(fit.parameters.damping, std::sqrt(noisy.variance(kDamping)));
    }
    fit.parameters = fit.drag.parameters;
    fit.residuals = swing_residuals(samples, fit.parameters);

    const SwingMask free = drag_mask(base, fit.drag.law);
    const NormalEquations at_best = linearise(samples, fit.parameters, weights);
    const ScoreCovariance scores =
        score_covariance(samples, fit.residuals, fit.parameters, weights, guess.period);
    const SwingMatrix c = inverse_information(at_best.information + prior, free);
    fit.from_noise = noise_covariance(c, scores);
    fit.from_tilt = c * tilt_prior * c;
    fit.by_radius = c.col(kRadius) * prior(kRadius, kRadius);

    // One more step without the radius' prior, with the radius known, and with the Earth's turning
    // set free.
    const auto one_free = [&](const SwingMatrix& known, const SwingMask& mask, int index) {
        const SwingMatrix inverse = inverse_information(at_best.information + known, mask);
        const SwingVector gradient =
            at_best.gradient + known * prior_offset(fit.parameters, priors);
        const double variance = noise_covariance(inverse, scores).variance(index) +
                                (inverse * known * inverse)(index, index);
        return std::pair((inverse * gradient)[index], std::sqrt(variance));
    };
    const auto radius = one_free(tilt_prior, free, kRadius);
    fit.free_radius = fit.parameters.radius + radius.first;
    fit.free_radius_u = radius.second;
    SwingMask radius_known = free;
    radius_known[kRadius] = false;
    fit.omega0_sq_u_at_radius = one_free(prior, radius_known, kOmega0Sq).second;
    SwingMask turning = free;
    turning[kTurning] = true;
    const auto turned = one_free(prior, turning, kTurning);
    fit.free_turning = fit.parameters.turning + turned.first;
    fit.free_turning_u = turned.second;

    double chi2 = 0.0;
    double n = 0.0;
    const auto own = residual_distances(samples, fit.residuals, Eigen::Matrix3d::Identity());
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (!fit.used[i]) continue;
        chi2 += own[i] * own[i];
        n += 3.0;
    }
    fit.reduced_chi2 = chi2 / (n - static_cast<double>(free.count()));
    return fit;
}

}  // namespace kinectlab
