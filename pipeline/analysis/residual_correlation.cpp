#include "pipeline/analysis/residual_correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

using Eigen::Array3d;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Share of the noise that lasts to the next sample; close together where it matters most.
constexpr std::array kShares{0.0,  0.1,  0.2,  0.3,  0.4,  0.5,  0.55, 0.6,  0.65,  0.7, 0.74,
                             0.78, 0.81, 0.84, 0.87, 0.89, 0.91, 0.93, 0.95, 0.965, 0.98};
constexpr double kNothing = 1e-9;  // mean square below which a direction has no noise at all

/// What lasts from each sample to the next; the first has none before it.
std::vector<double> lasting(std::span<const WhitenedSample> samples, double share, double step) {
    std::vector<double> phi(samples.size(), 0.0);
    if (share > 0.0)
        for (std::size_t i = 1; i < samples.size(); ++i)
            phi[i] = std::pow(share, (samples[i].t - samples[i - 1].t) / step);
    return phi;
}

struct Likelihood {
    double log = 0.0;
    Array3d variance = Array3d::Zero();  ///< of the noise, for each direction
    Array3d freedom = Array3d::Ones();   ///< how many samples it rests on
};

/// All samples below each other, three rows for each.
struct Stack {
    explicit Stack(std::span<const WhitenedSample> samples, Index n)
        : j(3 * static_cast<Index>(samples.size()), n), r(3 * static_cast<Index>(samples.size())) {
        Index row = 0;
        for (const auto& s : samples) {
            j.middleRows<3>(row) = s.j;
            r.segment<3>(row) = s.residual;
            row += 3;
        }
    }
    MatrixXd j;
    VectorXd r;
};

Likelihood restricted_likelihood(
    const Stack& all, const std::vector<double>& phi, const VectorXd& prior
) {
    const Index n = prior.size();
    Stack fresh = all;
    double log_volume = 0.0;
    for (std::size_t i = 1; i < phi.size(); ++i) {
        if (phi[i] == 0.0) continue;
        const auto row = 3 * static_cast<Index>(i);
        const double rest = std::sqrt(1.0 - phi[i] * phi[i]);
        fresh.j.middleRows<3>(row) -= phi[i] * all.j.middleRows<3>(row - 3);
        fresh.j.middleRows<3>(row) /= rest;
        fresh.r.segment<3>(row) -= phi[i] * all.r.segment<3>(row - 3);
        fresh.r.segment<3>(row) /= rest;
        log_volume += 2.0 * std::log(rest);
    }
    MatrixXd information = fresh.j.transpose() * fresh.j;
    information.diagonal() += prior;
    const VectorXd gradient = fresh.j.transpose() * fresh.r;
    const VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::LDLT<MatrixXd> solver(scale.asDiagonal() * information * scale.asDiagonal());
    const VectorXd moved =
        scale.asDiagonal() * solver.solve(VectorXd(scale.asDiagonal() * gradient));
    const MatrixXd inverse =
        scale.asDiagonal() * solver.solve(MatrixXd::Identity(n, n)) * scale.asDiagonal();
    const VectorXd left = (fresh.r - fresh.j * moved).cwiseAbs2();
    const VectorXd leverage = (fresh.j * inverse).cwiseProduct(fresh.j).rowwise().sum();
    const auto count = static_cast<double>(phi.size());
    Likelihood out;
    out.log =
        -0.5 * (solver.vectorD().array().max(1e-300).log().sum() - 2.0 * scale.array().log().sum());
    for (Index k = 0; k < 3; ++k) {
        double squares = 0.0;
        double spent = 0.0;
        for (Index row = k; row < left.size(); row += 3) {
            squares += left[row];
            spent += leverage[row];
        }
        out.freedom[k] = std::max(count - spent, 1.0);
        out.variance[k] = squares / out.freedom[k];
        if (out.variance[k] < kNothing) continue;
        out.log -= 0.5 * (out.freedom[k] * std::log(out.variance[k]) + log_volume);
    }
    return out;
}

/// Student's factor squared, for 68 %, of a variance known from so few samples that last: those of
/// `share` count as (1 - share²)/(1 + share²) each (Bayley and Hammersley, J. R. Stat. Soc. Suppl.
/// 8 (1946)).
Array3d widening(const Array3d& freedom, double share) {
    const double worth = (1.0 - share * share) / (1.0 + share * share);
    const Array3d one_over = (freedom * worth).max(1.0).inverse();
    return (1.0 + 0.5 * one_over + 0.25 * one_over.square()).square();
}

MatrixXd sandwich(
    std::span<const WhitenedSample> samples,
    const std::vector<double>& phi,
    const Array3d& variance,
    const MatrixXd& c
) {
    MatrixXd sum = MatrixXd::Zero(c.rows(), c.cols());
    MatrixXd before = MatrixXd::Zero(3, c.cols());
    const Vector3d root = variance.sqrt().matrix();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const MatrixXd j = root.asDiagonal() * samples[i].j;
        if (i > 0) before = phi[i] * (before + root.asDiagonal() * samples[i - 1].j);
        const MatrixXd cross = j.transpose() * before;
        sum.noalias() += j.transpose() * j + cross + cross.transpose();
    }
    return c * sum * c;
}

}  // namespace

MatrixXd covariance_by_lasting_noise(
    std::span<const WhitenedSample> samples, const MatrixXd& c, const VectorXd& prior
) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < samples.size(); ++i)
        steps.push_back(samples[i].t - samples[i - 1].t);
    const double step = steps.empty() ? 1.0 : median(std::move(steps));
    const Stack stack(samples, prior.size());
    std::vector<Likelihood> all;
    double best = -1e300;
    for (const double share : kShares) {
        all.push_back(restricted_likelihood(stack, lasting(samples, share, step), prior));
        best = std::max(best, all.back().log);
    }
    MatrixXd sum = MatrixXd::Zero(c.rows(), c.cols());
    double weights = 0.0;
    for (std::size_t k = 0; k < kShares.size(); ++k) {
        const double low = kShares[k == 0 ? 0 : k - 1];
        const double high = kShares[std::min(k + 1, kShares.size() - 1)];
        const double weight = (high - low) * std::exp(all[k].log - best);
        if (weight < 1e-6) continue;
        const Array3d variance = all[k].variance * widening(all[k].freedom, kShares[k]);
        sum += weight * sandwich(samples, lasting(samples, kShares[k], step), variance, c);
        weights += weight;
    }
    return sum / weights;
}

MatrixXd covariance_by_products(
    std::span<const WhitenedSample> samples, const MatrixXd& c, double correlation_time_s
) {
    const Index n = c.rows();
    std::vector<VectorXd> scores;
    scores.reserve(samples.size());
    for (const auto& s : samples)
        scores.emplace_back(s.j.transpose() * s.residual);
    MatrixXd sum = MatrixXd::Zero(n, n);
    for (std::size_t a = 0; a < scores.size(); ++a) {
        VectorXd before = VectorXd::Zero(n);
        for (std::size_t b = a; b-- > 0;) {
            const double lag = (samples[a].t - samples[b].t) / correlation_time_s;
            if (lag >= 1.0) break;
            before += (1.0 - lag) * scores[b];
        }
        const MatrixXd cross = scores[a] * before.transpose();
        sum.noalias() += scores[a] * scores[a].transpose() + cross + cross.transpose();
    }
    return c * sum * c;
}

}  // namespace kinectlab
