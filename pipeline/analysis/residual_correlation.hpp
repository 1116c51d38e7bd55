#pragma once

#include <span>

#include <Eigen/Core>

namespace kinectlab {

/// One sample of a finished fit, in units in which its noise is about one in every direction.
struct WhitenedSample {
    double t = 0.0;                              ///< s
    Eigen::Vector3d residual;                    ///< measured minus fitted
    Eigen::Matrix<double, 3, Eigen::Dynamic> j;  ///< its derivatives by the free parameters
};

/// Covariance of least-squares parameters by noise of which each sample takes a part over from the
/// one before it, exp(-dt/τ). `c` is the inverse of the information that the fit used, with
/// `prior`, the information of the priors, on its diagonal. τ is not chosen but averaged over, each
/// weighted by its restricted likelihood (Patterson and Thompson, Biometrika 58 (1971)), which
/// knows that the fit has taken its share of slow noise: from twenty samples the residuals alone
/// would seem nearly white. The size of the noise comes out for each direction.
[[nodiscard]] Eigen::MatrixXd covariance_by_lasting_noise(
    std::span<const WhitenedSample> samples, const Eigen::MatrixXd& c, const Eigen::VectorXd& prior
);

/// The same without a model of the noise: each sample's own residual (White, Econometrica 48
/// (1980)) and products of neighbours up to `correlation_time_s` apart (Newey and West,
/// Econometrica 55 (1987)). Good where samples are many.
[[nodiscard]] Eigen::MatrixXd covariance_by_products(
    std::span<const WhitenedSample> samples, const Eigen::MatrixXd& c, double correlation_time_s
);

}  // namespace kinectlab
