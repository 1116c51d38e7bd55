#pragma once

#include <span>

#include "pipeline/analysis/path_stretch.hpp"
#include "pipeline/analysis/spring_model.hpp"

namespace kinectlab {

/// Samples in which the mass surely moves on its spring, and roughly how.
struct SpringGuess {
    Stretch known;
    double t0 = 0.0;  ///< of the parameters, s
    SpringAxes axes;
    Eigen::VectorXd parameters;
};

/// `drive_omega`: rad/s, 0 without a drive. Free: the spectrum of the motion along its main line
/// gives the frequency, the three periods that look most like a sine the rest. Driven: the best of
/// a raster of resonance frequencies and dampings over the whole recording or half of it.
/// Errors (bad_data): no motion beyond noise, none that repeats, fewer than three periods.
[[nodiscard]] Result<SpringGuess> guess_spring(
    std::span<const PositionSample> samples, double drive_omega
);

}  // namespace kinectlab
