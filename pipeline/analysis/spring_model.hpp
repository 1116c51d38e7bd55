#pragma once

#include <span>

#include <Eigen/Core>

namespace kinectlab {

/// Where the parameters of a mass on a spring stand in their vector; 0 to 2 are where it rests, m.
enum SpringParameter : int {
    kSpringLeanA = 3,  ///< of the line of motion off the axis, along its first ...
    kSpringLeanB,      ///< ... and its second side
    kSpringOmega,      ///< without damping, rad/s
    kSpringDamping,    ///< γ, 1/s
    kSpringQuadratic,  ///< β, of the square of the speed, 1/m
    kSpringCos,        ///< of the free oscillation at t0, m
    kSpringSin,
    kSpringDriveOmega,  ///< rad/s
    kSpringDriveCos,    ///< of the steady oscillation at t0, m
    kSpringDriveSin,
    kSpringParameters
};

/// The line along which the mass moves, roughly, and two sides across it.
struct SpringAxes {
    Eigen::Vector3d along = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d side_a = Eigen::Vector3d::UnitX();
    Eigen::Vector3d side_b = Eigen::Vector3d::UnitY();
};

/// Sides of a line (of length 1).
[[nodiscard]] SpringAxes spring_axes(const Eigen::Vector3d& along);

/// The fitted line, lab frame, of length 1.
[[nodiscard]] Eigen::Vector3d spring_direction(const Eigen::VectorXd& x, const SpringAxes& axes);

/// ω of the free, damped oscillation, rad/s; NaN where the damping leaves none.
[[nodiscard]] double damped_omega(const Eigen::VectorXd& x);

/// x'' = -ω₀² x - 2γ x' - β |x'| x' + drive cos(ω_d t + φ): what is left of the start plus the
/// steady answer. The quadratic drag acts on the amplitude by its mean over a swing (Landau and
/// Lifshitz, Mechanics, §25; Nayfeh, Perturbation Methods, ch. 5), R' = -γR - (4/3π) β ω₀ R²; it is
/// not for use with a drive. Times in s, positions in m, lab frame.
void spring_path(
    const Eigen::VectorXd& x,
    const SpringAxes& axes,
    double t0,
    std::span<const double> t,
    std::span<Eigen::Vector3d> p
);

/// The same motion with another t0.
[[nodiscard]] Eigen::VectorXd spring_later(const Eigen::VectorXd& x, double later_s);

}  // namespace kinectlab
