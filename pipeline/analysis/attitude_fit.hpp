#pragma once

#include <functional>
#include <span>

#include "pipeline/analysis/attitude_samples.hpp"
#include "pipeline/analysis/residual_fit.hpp"

namespace kinectlab {

/// Attitudes q_lab_obj at the given times (s, increasing) for a set of parameters. A parameter set
/// without a motion gives NaN.
using AttitudeModel = std::function<void(
    const Eigen::VectorXd& parameters,
    std::span<const double> t,
    std::span<Eigen::Quaterniond> q_lab_obj
)>;

/// Fits a turning to all attitudes at once, as fit_residuals does: a residual is the rotation
/// vector in the lab frame from the fitted to the measured attitude, whitened by the sample's
/// covariance, so q and -q are one and nothing jumps at ±180°. With `alike`, each attitude is the
/// one of a plain box's four likes that is nearest to the fit.
[[nodiscard]] Result<ResidualFit> fit_attitudes(
    std::span<const AttitudeSample> samples,
    const AttitudeModel& model,
    std::span<const PathParameter> parameters,
    bool alike = false
);

}  // namespace kinectlab
