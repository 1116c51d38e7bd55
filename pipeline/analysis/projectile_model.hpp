#pragma once

#include <span>

#include <Eigen/Core>

namespace kinectlab {

/// Where the parameters of a flight stand in their vector.
enum ProjectileParameter : int {
    kFlightX,  ///< position at t0, m; y and z follow
    kFlightY,
    kFlightZ,
    kFlightVx,  ///< velocity at t0, m/s
    kFlightVy,
    kFlightVz,
    kFlightG,      ///< acceleration downwards without drag, m/s²
    kFlightTiltX,  ///< lean of "up" along x and y of the lab frame
    kFlightTiltY,
    kFlightDrag,  ///< of the square of the speed, 1/m
    kFlightParameters
};

/// "Up" in the lab frame, of length 1.
[[nodiscard]] Eigen::Vector3d flight_up(const Eigen::VectorXd& parameters);

/// The velocity at t0, m/s.
[[nodiscard]] Eigen::Vector3d flight_velocity(const Eigen::VectorXd& parameters);

/// p'' = -g up - k |p'| p' from t0 on (and backwards from it), by Runge and Kutta's fourth order in
/// steps of at most 1/60 s. Times in s, positions in m, lab frame.
void projectile_path(
    const Eigen::VectorXd& parameters,
    double t0,
    std::span<const double> t,
    std::span<Eigen::Vector3d> p
);

/// The highest point of a flight that starts upwards; one that starts downwards has it at t0.
struct FlightTop {
    double rise = 0.0;  ///< above the start, m
    double time = 0.0;  ///< after the start, s
};

[[nodiscard]] FlightTop flight_top(const Eigen::VectorXd& parameters);

}  // namespace kinectlab
