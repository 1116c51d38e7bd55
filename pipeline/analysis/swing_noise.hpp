#pragma once

#include <span>
#include <vector>

#include "pipeline/analysis/least_squares.hpp"

namespace kinectlab {

/// How far each residual is out, in the sigmas of its sample after `rescale`.
[[nodiscard]] std::vector<double> residual_distances(
    std::span<const PositionSample> samples,
    const std::vector<Eigen::Vector3d>& residuals,
    const Eigen::Matrix3d& rescale
);

/// By how much the residuals exceed the samples' own sigma; by the median, so that outliers do not
/// tell.
[[nodiscard]] double noise_factor(
    std::span<const PositionSample> samples, const std::vector<Eigen::Vector3d>& residuals
);

/// Makes the used residuals white on average, whatever the given covariances say of their shape;
/// the median of all sets the size if that is larger, so that nothing shrinks what counts as an
/// outlier.
[[nodiscard]] Eigen::Matrix3d whiten_residuals(
    std::span<const PositionSample> samples,
    const std::vector<Eigen::Vector3d>& residuals,
    const std::vector<bool>& use
);

/// Sum of the products of the samples' scores.
struct ScoreCovariance {
    SwingMatrix independent;  ///< each sample with its own noise (White, Econometrica 48 (1980))
    SwingMatrix correlated;   ///< and with its neighbours' (Newey and West, ibid. 55 (1987))
};

/// At all lags up to a quarter period, Bartlett-weighted.
[[nodiscard]] ScoreCovariance score_covariance(
    std::span<const PositionSample> samples,
    const std::vector<Eigen::Vector3d>& residuals,
    const SwingParameters& parameters,
    const SwingWeights& weights,
    double period
);

/// What the positions' noise does to the parameters.
struct NoiseCovariance {
    SwingMatrix independent = SwingMatrix::Zero();  ///< as if no sample knew of its neighbours
    SwingMatrix correlated = SwingMatrix::Zero();   ///< with what lasts for some frames

    /// Of a number with this gradient: correlation widens it, never narrows it. In the number's own
    /// direction, because parameters by themselves are often strongly correlated.
    [[nodiscard]] double variance(const SwingVector& gradient) const;
    [[nodiscard]] double variance(int parameter) const;
};

/// For parameters whose normal equations have this inverse.
[[nodiscard]] NoiseCovariance noise_covariance(
    const SwingMatrix& inverse, const ScoreCovariance& scores
);

}  // namespace kinectlab
