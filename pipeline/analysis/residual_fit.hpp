#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/analysis/path_fit.hpp"
#include "pipeline/core/error.hpp"

namespace kinectlab {

/// Which thing a residual of three numbers is of, and when; each thing's in time order.
struct ResidualPlace {
    int series = 0;
    double t = 0.0;  ///< s
};

/// Measured minus fitted at all places, in units of each sample's own uncertainty: positions of
/// several objects, rotation vectors, or both. A parameter set without a motion gives NaN.
using ResidualModel =
    std::function<void(const Eigen::VectorXd& parameters, std::span<Eigen::Vector3d> whitened)>;

struct ResidualFitSettings {
    double outlier_sigma = 4.5;     ///< in three dimensions
    double longest_memory_s = 1.0;  ///< over which the noise of neighbours may be alike
};

struct ResidualFit {
    Eigen::VectorXd parameters;
    Eigen::MatrixXd from_noise;  ///< covariance by the samples' own noise
    /// Column i: the parameters' change by one standard uncertainty of what was known before of i.
    Eigen::MatrixXd by_prior;
    std::vector<Eigen::Vector3d> residuals;  ///< whitened as the model gave them
    std::vector<bool> used;                  ///< false = outlier
    int outliers = 0;
    double reduced_chi2 = 0.0;  ///< of the used ones, against the covariances they came with
    int degrees_of_freedom = 0;
    double memory_s = 0.0;  ///< for how long the residuals stay alike

    [[nodiscard]] Eigen::MatrixXd covariance() const {
        return from_noise + by_prior * by_prior.transpose();
    }
};

/// Fits parameters to residuals of any kind: Levenberg-Marquardt with Huber's cost, then plain
/// least squares without what lies beyond `outlier_sigma`. The residuals say how large the noise of
/// each thing is in each direction and, through NoiseMemories, for how long it lasts; the
/// covariance is that of the least-squares estimate under such noise, weighted over the memories,
/// and wider where few independent samples know the noise's size (GUM Supplement 1, 6.4.9).
/// Errors (bad_data): no more samples than parameters, a start that gives no number.
[[nodiscard]] Result<ResidualFit> fit_residuals(
    std::span<const ResidualPlace> places,
    const ResidualModel& model,
    std::span<const PathParameter> parameters,
    const ResidualFitSettings& settings = {}
);

/// The change of a number that is made of the parameters, by each of them: central differences over
/// a tenth of the parameter's uncertainty.
[[nodiscard]] Eigen::VectorXd gradient_of(
    const std::function<double(const Eigen::VectorXd&)>& formula,
    const Eigen::VectorXd& parameters,
    const Eigen::MatrixXd& covariance
);

}  // namespace kinectlab
