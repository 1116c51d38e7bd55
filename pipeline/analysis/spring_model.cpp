#include "pipeline/analysis/spring_model.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Complex = std::complex<double>;

/// How the amplitude has fallen after a time; NaN where it would not be finite.
double fall(const VectorXd& x, double tau) {
    const double gamma = x[kSpringDamping];
    const double decay = std::exp(-gamma * tau);
    const double y = gamma * tau;
    const double lasted = std::abs(y) < 1e-6 ? tau * (1.0 - y / 2.0) : -std::expm1(-y) / gamma;
    const double rate = 4.0 / (3.0 * std::numbers::pi) * x[kSpringQuadratic] * x[kSpringOmega] *
                        std::hypot(x[kSpringCos], x[kSpringSin]);
    const double below = 1.0 + rate * lasted;
    return below > 0.0 ? decay / below : std::numeric_limits<double>::quiet_NaN();
}

Complex free_part(const VectorXd& x, double tau) {
    return fall(x, tau) * Complex(x[kSpringCos], -x[kSpringSin]) *
           std::polar(1.0, damped_omega(x) * tau);
}

Complex driven_part(const VectorXd& x, double tau) {
    return Complex(x[kSpringDriveCos], -x[kSpringDriveSin]) *
           std::polar(1.0, x[kSpringDriveOmega] * tau);
}

}  // namespace

SpringAxes spring_axes(const Vector3d& along) {
    const Vector3d side = along.unitOrthogonal();
    return {along, side, along.cross(side)};
}

Vector3d spring_direction(const VectorXd& x, const SpringAxes& axes) {
    return (axes.along + x[kSpringLeanA] * axes.side_a + x[kSpringLeanB] * axes.side_b)
        .normalized();
}

double damped_omega(const VectorXd& x) {
    return std::sqrt(x[kSpringOmega] * x[kSpringOmega] - x[kSpringDamping] * x[kSpringDamping]);
}

void spring_path(
    const VectorXd& x,
    const SpringAxes& axes,
    double t0,
    std::span<const double> t,
    std::span<Vector3d> p
) {
    const Vector3d rest = x.head<3>();
    const Vector3d along = spring_direction(x, axes);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double tau = t[i] - t0;
        p[i] = rest + along * (free_part(x, tau) + driven_part(x, tau)).real();
    }
}

VectorXd spring_later(const VectorXd& x, double later_s) {
    VectorXd moved = x;
    const Complex free = free_part(x, later_s);
    const Complex driven = driven_part(x, later_s);
    moved[kSpringCos] = free.real();
    moved[kSpringSin] = -free.imag();
    moved[kSpringDriveCos] = driven.real();
    moved[kSpringDriveSin] = -driven.imag();
    return moved;
}

}  // namespace kinectlab
