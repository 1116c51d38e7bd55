#include "pipeline/analysis/swing_noise.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

constexpr double kMedianChi2 = 2.366;  // of three degrees of freedom
constexpr double kSmallestNoise =
    1e-6;  // share of the given variance below which residuals are rounding

using Samples = std::span<const PositionSample>;
using Residuals = std::vector<Eigen::Vector3d>;

}  // namespace

std::vector<double> residual_distances(
    Samples samples, const Residuals& residuals, const Eigen::Matrix3d& rescale
) {
    std::vector<double> d(samples.size());
    for (std::size_t i = 0; i < d.size(); ++i)
        d[i] = (rescale * samples[i].whiten * residuals[i]).norm();
    return d;
}

double noise_factor(Samples samples, const Residuals& residuals) {
    const double m = median(residual_distances(samples, residuals, Eigen::Matrix3d::Identity()));
    return std::max(m / std::sqrt(kMedianChi2), std::sqrt(kSmallestNoise));
}

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
    const double size =
        median(residual_distances(samples, residuals, whiten)) / std::sqrt(kMedianChi2);
    return whiten / std::max(size, 1.0);
}

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

double NoiseCovariance::variance(const SwingVector& gradient) const {
    return std::max(gradient.dot(independent * gradient), gradient.dot(correlated * gradient));
}

double NoiseCovariance::variance(int parameter) const {
    return std::max(independent(parameter, parameter), correlated(parameter, parameter));
}

NoiseCovariance noise_covariance(const SwingMatrix& inverse, const ScoreCovariance& scores) {
    return {inverse * scores.independent * inverse, inverse * scores.correlated * inverse};
}

}  // namespace kinectlab
