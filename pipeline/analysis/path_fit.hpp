#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/core/error.hpp"

namespace kinectlab {

/// Positions (m, lab frame) at the given times (s, increasing) for a set of parameters. A parameter
/// set without a motion gives NaN.
using PathModel = std::function<void(
    const Eigen::VectorXd& parameters, std::span<const double> t, std::span<Eigen::Vector3d> p
)>;

/// One parameter of a path.
struct PathParameter {
    double start = 0.0;  ///< where the search begins
    double scale =
        1.0;  ///< a change of this size changes the path clearly; sets the difference step
    double prior = 0.0;  ///< what is known of it before ...
    double prior_u =
        -1;  ///< ... with this standard uncertainty; 0: it is fixed at `prior`; negative: nothing
};

struct PathFitSettings {
    double outlier_sigma = 4.5;  ///< in three dimensions
    double correlation_time_s =
        0.1;  ///< over which products of neighbours count as noise that lasts
    bool allow_outliers = true;
};

struct PathFit {
    Eigen::VectorXd parameters;
    Eigen::MatrixXd from_noise;   ///< covariance by the positions' own noise
    Eigen::MatrixXd from_priors;  ///< covariance by what was known before; their sum is the whole
    /// Column k: what the parameters change by when the prior of parameter k is off by its
    /// uncertainty; from_priors is the sum of their squares.
    Eigen::MatrixXd by_prior;
    std::vector<Eigen::Vector3d> residuals;  ///< of all samples, m
    std::vector<bool> used;                  ///< false = outlier
    int outliers = 0;
    double reduced_chi2 = 0.0;  ///< of the used ones, against the covariances they came with
    /// Sum of squares of the used ones in units of the noise that the residuals themselves show;
    /// two models of the same samples are compared by it.
    double sum_of_squares = 0.0;
    int degrees_of_freedom = 0;

    [[nodiscard]] Eigen::MatrixXd covariance() const { return from_noise + from_priors; }
};

/// Fits a path to all positions at once: Levenberg-Marquardt with Huber's cost, then plain least
/// squares without what lies beyond `outlier_sigma`; the noise is rescaled in each direction by
/// what the residuals show, and the covariance takes in how long it lasts
/// (residual_correlation.hpp). Errors (bad_data): no more samples than parameters, a start whose
/// path is no number.
[[nodiscard]] Result<PathFit> fit_path(
    std::span<const PositionSample> samples,
    const PathModel& model,
    std::span<const PathParameter> parameters,
    const PathFitSettings& settings = {}
);

/// The change of a number that is made of the parameters, by each of them: central differences over
/// a tenth of the parameter's uncertainty.
[[nodiscard]] Eigen::VectorXd gradient_of(
    const std::function<double(const Eigen::VectorXd&)>& formula, const PathFit& fit
);

}  // namespace kinectlab
