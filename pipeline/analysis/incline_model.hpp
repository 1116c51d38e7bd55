#pragma once

#include <span>

#include <Eigen/Core>

namespace kinectlab {

/// Where the parameters of a roll stand in their vector; 0 to 2 are the position at t0, m.
enum InclineParameter : int {
    kInclineHeading = 3,  ///< of the way down, from x to y of the lab frame, rad
    kInclineSlope,        ///< below the horizontal, rad
    kInclineV,            ///< down the slope at t0, m/s
    kInclineA,            ///< without drag, m/s²
    kInclineDrag,         ///< of the speed, 1/s
    kInclineParameters
};

/// Down the slope, lab frame, of length 1.
[[nodiscard]] Eigen::Vector3d incline_direction(const Eigen::VectorXd& parameters);

/// s'' = a - c s' along a straight line, in closed form. Times in s, positions in m, lab frame.
void incline_path(
    const Eigen::VectorXd& parameters,
    double t0,
    std::span<const double> t,
    std::span<Eigen::Vector3d> p
);

}  // namespace kinectlab
