#pragma once

#include <span>
#include <vector>

#include "pipeline/analysis/least_squares.hpp"
#include "pipeline/analysis/position_samples.hpp"
#include "pipeline/analysis/swing_drag.hpp"
#include "pipeline/analysis/swing_guess.hpp"
#include "pipeline/analysis/swing_model.hpp"
#include "pipeline/analysis/swing_noise.hpp"

namespace kinectlab {

/// The least-squares fit to a free swing.
struct SwingFit {
    SwingParameters parameters;  ///< time 0 is that of sample `begin`
    std::size_t begin = 0;       ///< the free swing: samples [begin, end)
    std::size_t end = 0;
    double free_radius = 0.0;  ///< of the arc, from the positions alone, m
    double free_radius_u = 0.0;
    double omega0_sq_u_at_radius = 0.0;  ///< of omega0_sq if the arc's radius were known, 1/s²
    double free_turning = 0.0;           ///< of the swing plane beyond what its ellipse does, rad/s
    double free_turning_u = 0.0;
    std::vector<bool> used;                  ///< of the samples [begin, end): false = outlier
    std::vector<Eigen::Vector3d> residuals;  ///< of the samples [begin, end), m
    double reduced_chi2 = 0.0;  ///< of the used ones, against the covariances they came with

    DragChoice drag;

    // Where the covariance of the parameters (of those that were free) comes from; they add up.
    NoiseCovariance from_noise;  ///< of the positions
    SwingMatrix from_tilt;       ///< the lab frame's level
    SwingVector by_radius;       ///< change of the parameters for each metre of the prior radius
};

/// The error's message where the equation cannot follow the motion.
inline constexpr const char* kAnotherMotion =
    "the motion is not that of a pendulum of the given length";

/// Fits all parameters (the Earth's turning only if it is free) to all samples of the free swing
/// that the guess lies in. Grows outward from the guess until the samples stop following the
/// equation of motion (held, not yet released, stopped), robust at first (Huber), then by plain
/// least squares without the outliers beyond 4.5 sigma. The noise is rescaled by what the residuals
/// show in each direction, and its covariance takes in their correlation in time (swing_noise.hpp).
/// The drag is chosen last. Errors (bad_data): less than three periods of free swing, motion that
/// the equation cannot follow, amplitude beyond 80°.
[[nodiscard]] Result<SwingFit> fit_swing(
    std::span<const PositionSample> samples,
    const SwingGuess& guess,
    const SwingPriors& priors,
    bool turning_free = false
);

/// The largest angle from the plumb line that the bob would reach from the parameters' time 0 on
/// without damping, rad.
[[nodiscard]] double turning_angle(const SwingParameters& parameters);

/// The amplitude of a plane swing with the same energy, rad. Its square counts for the period.
[[nodiscard]] double energy_angle(const SwingParameters& parameters);

}  // namespace kinectlab
