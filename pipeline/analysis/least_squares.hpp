#pragma once

#include <span>
#include <vector>

#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/analysis/swing_model.hpp"

namespace kinectlab {

/// What is known before the first picture.
struct SwingPriors {
    double radius = 1.0;         ///< m
    double radius_sigma = 1e-3;  ///< m; 0 = exactly known, infinity = not at all
    double tilt_sigma = 0.02;    ///< rad: how well the lab frame is levelled
};

/// How the samples count in a least-squares fit.
struct SwingWeights {
    Eigen::Matrix3d rescale =
        Eigen::Matrix3d::Identity();  ///< applied after a sample's own whitening
    double huber = 3.0;     ///< sigma beyond which the cost grows linearly; infinity = never
    std::vector<bool> use;  ///< false = ignored; empty = all count
};

/// The sum of squares (or Huber's cost) about one set of parameters.
struct NormalEquations {
    double cost = 0.0;
    SwingMatrix information = SwingMatrix::Zero();  ///< of the samples alone
    SwingVector gradient = SwingVector::Zero();     ///< of the samples alone, downhill
};

/// Residuals measured minus fitted, m. Time 0 is that of the first sample.
[[nodiscard]] std::vector<Eigen::Vector3d> swing_residuals(
    std::span<const PositionSample> samples, const SwingParameters& parameters
);

[[nodiscard]] NormalEquations linearise(
    std::span<const PositionSample> samples,
    const SwingParameters& parameters,
    const SwingWeights& weights
);

/// Information of the priors alone, on radius and tilt.
[[nodiscard]] SwingMatrix prior_information(const SwingPriors& priors);

/// From the parameters to what the priors say, zero where they say nothing.
[[nodiscard]] SwingVector prior_offset(
    const SwingParameters& parameters, const SwingPriors& priors
);

/// Inverse over the free parameters, zero elsewhere.
[[nodiscard]] SwingMatrix inverse_information(
    const SwingMatrix& information, const SwingMask& free
);

/// Levenberg-Marquardt with Marquardt's scaling; what is not free stays as it starts. Ends when the
/// next step would be shorter than `tolerance` standard deviations.
[[nodiscard]] SwingParameters minimise(
    std::span<const PositionSample> samples,
    SwingParameters start,
    const SwingWeights& weights,
    const SwingPriors& priors,
    const SwingMask& free,
    double tolerance = 1e-2
);

}  // namespace kinectlab
