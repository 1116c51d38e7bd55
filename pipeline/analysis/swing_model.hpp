#pragma once

#include <bitset>

#include <Eigen/Core>

namespace kinectlab {

/// What moves a damped spherical pendulum on the turning Earth, and where it is seen.
/// The bob is a solid sphere that turns with the string, so that pivot, string and bob are one
/// rigid body: it moves like a point on a string with omega0_sq = g L / (L² + 2r²/5).
struct SwingParameters {
    Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< lab frame, m
    double radius = 1.0;                              ///< of the arc as measured, m
    Eigen::Vector3d n = -Eigen::Vector3d::UnitZ();    ///< pivot to bob at time 0, length 1
    Eigen::Vector3d v = Eigen::Vector3d::Zero();      ///< dn/dt at time 0, 1/s, across n
    double omega0_sq = 9.81;                          ///< 1/s²
    Eigen::Vector2d tilt = Eigen::Vector2d::Zero();   ///< of the plumb line in the lab frame: x, y
    double damping = 0.0;                             ///< amplitude falls as exp(-damping t), 1/s
    double quadratic = 0.0;  ///< drag that grows as the speed squared, 1/rad
    double turning = 0.0;    ///< vertical part of the Earth's turning, rad/s

    /// Where things fall, length 1.
    [[nodiscard]] Eigen::Vector3d down() const {
        return Eigen::Vector3d(tilt.x(), tilt.y(), -1.0).normalized();
    }
};

/// The places of the parameters in gradients and covariances. Direction and velocity at time 0 have
/// two each, along the axes that tangent_axes() gives.
enum SwingIndex {
    kPivot = 0,
    kRadius = 3,
    kDirection = 4,
    kVelocity = 6,
    kOmega0Sq = 8,
    kTilt = 9,
    kDamping = 11,
    kQuadratic = 12,
    kTurning = 13,
    kSwingParameters = 14,
};

/// Which parameters a fit may change.
using SwingMask = std::bitset<kSwingParameters>;

using SwingVector = Eigen::Matrix<double, kSwingParameters, 1>;
using SwingMatrix = Eigen::Matrix<double, kSwingParameters, kSwingParameters>;
using SwingJacobian = Eigen::Matrix<double, 3, kSwingParameters>;

/// Two directions across n, as columns.
[[nodiscard]] Eigen::Matrix<double, 3, 2> tangent_axes(const Eigen::Vector3d& n);

/// The parameters after a step; n keeps its length and v stays across n.
[[nodiscard]] SwingParameters moved(const SwingParameters& parameters, const SwingVector& step);

/// Follows a swing and how it depends on the parameters, forward or backward in time.
///   n'' = w² (d - (d·n) n) - |n'|² n - 2γ n' - β |n'| n' - 2Ω (z × n')ₜ
/// with d down, γ the damping, β the quadratic drag, Ω the vertical part of the Earth's turning and
/// ₜ the part across n. The horizontal part of its turning pushes along the string; what remains
/// across it is 1e-6 of gravity. Integrated by Dormand and Prince's fifth-order method, J. Comp.
/// Appl. Math. 6 (1980), at steps that keep the frequency right to 1e-9.
class SwingPath {
public:
    explicit SwingPath(const SwingParameters& start);

    /// Goes on to time t in seconds; any t.
    void go_to(double t);

    [[nodiscard]] Eigen::Vector3d position() const;  ///< lab frame, m
    [[nodiscard]] SwingJacobian jacobian() const;    ///< of the position, by the start's parameters
    [[nodiscard]] SwingParameters now() const;       ///< the same swing with time 0 moved here

    /// One row for the motion itself, then one for each parameter that shapes it; the columns are
    /// n and dn/dt.
    using State = Eigen::Matrix<double, 11, 6>;

private:
    SwingParameters start_;
    double t_ = 0.0;
    double longest_step_;
    State state_;
};

/// Period of a pendulum at amplitude theta over that of small swings: (2/π) K(sin θ/2), by the
/// arithmetic-geometric mean. For theta from 0 to below π.
[[nodiscard]] double period_factor(double theta);

}  // namespace kinectlab
