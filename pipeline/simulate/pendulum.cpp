#include "pipeline/simulate/pendulum.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "pipeline/core/number_text.hpp"

namespace kinectlab::simulate {
namespace {

constexpr double kEarthRate = 7.2921159e-5;  ///< rad/s, against the stars
constexpr double kStep = 1.0 / 1024.0;  ///< s; phase error (ωh)⁴/120, below 1e-11 for L = 0.2 m

Result<void> check_range(const char* field, double value, double low, double high) {
    if (value >= low && value <= high) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is " + number_text(value),
        "give a number from " + number_text(low) + " to " + number_text(high)
    );
}

}  // namespace

Result<void> check(const PendulumParameters& p) {
    const double largest_bob = std::min(0.12, 0.5 * p.length_m);
    if (auto ok = check_range("length_m", p.length_m, 0.2, 3.0); !ok) return ok;
    if (auto ok = check_range("bob_radius_m", p.bob_radius_m, 0.01, largest_bob); !ok) return ok;
    if (auto ok = check_range("gravity", p.gravity_m_s2, 0.5, 30.0); !ok) return ok;
    if (auto ok = check_range("latitude_deg", p.latitude_deg, -90.0, 90.0); !ok) return ok;
    return check_range("damping_per_s", p.damping_per_s, 0.0, 1.0);
}

PendulumEquation::PendulumEquation(const PendulumParameters& p) : damping_(p.damping_per_s) {
    const double length = p.length_m;
    const double kappa = length / (length * length + 0.4 * p.bob_radius_m * p.bob_radius_m);
    const double latitude = p.latitude_deg * std::numbers::pi / 180.0;
    gravity_ = {0.0, 0.0, -kappa * p.gravity_m_s2};
    earth_rate_ = kEarthRate * Eigen::Vector3d(0.0, std::cos(latitude), std::sin(latitude));
}

Eigen::Vector3d PendulumEquation::acceleration(const SwingState& s) const {
    const Eigen::Vector3d pull =
        gravity_ - 2.0 * earth_rate_.cross(s.n_dot) - 2.0 * damping_ * s.n_dot;
    return pull - (s.n.dot(pull) + s.n_dot.squaredNorm()) * s.n;
}

SwingState PendulumEquation::step(const SwingState& s, double dt) const {
    const auto moved = [](const SwingState& from, const SwingState& slope, double h) {
        return SwingState{from.n + h * slope.n, from.n_dot + h * slope.n_dot};
    };
    const auto slope = [this](const SwingState& at) {
        return SwingState{at.n_dot, acceleration(at)};
    };
    const SwingState k1 = slope(s);
    const SwingState k2 = slope(moved(s, k1, 0.5 * dt));
    const SwingState k3 = slope(moved(s, k2, 0.5 * dt));
    const SwingState k4 = slope(moved(s, k3, dt));
    SwingState next;
    next.n = s.n + dt / 6.0 * (k1.n + 2.0 * k2.n + 2.0 * k3.n + k4.n);
    next.n_dot = s.n_dot + dt / 6.0 * (k1.n_dot + 2.0 * k2.n_dot + 2.0 * k3.n_dot + k4.n_dot);
    next.n.normalize();
    next.n_dot -= next.n.dot(next.n_dot) * next.n;
    return next;
}

double PendulumEquation::energy(const SwingState& s) const {
    return 0.5 * s.n_dot.squaredNorm() - gravity_.dot(s.n);
}

Swing::Swing(const PendulumParameters& parameters, const SwingState& start)
    : equation_(parameters), grid_state_(start) {}

SwingState Swing::at(double t_s) {
    while (static_cast<double>(grid_steps_ + 1) * kStep <= t_s) {
        grid_state_ = equation_.step(grid_state_, kStep);
        ++grid_steps_;
    }
    return equation_.step(grid_state_, t_s - static_cast<double>(grid_steps_) * kStep);
}

}  // namespace kinectlab::simulate
