#include "pipeline/simulate/pendulum.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace kinectlab::simulate {
namespace {

constexpr double kEarthRate = 7.2921159e-5;  ///< rad/s, against the stars
constexpr double kStep = 1.0 / 1024.0;  ///< s; phase error (ωh)⁴/120, below 1e-11 for L = 0.2 m

constexpr PendulumParameters kUsual;
constexpr std::array kRanges = {
    ParameterRange{"length_m", 0.2, 3.0, kUsual.length_m},
    ParameterRange{"bob_radius_m", 0.01, 0.12, kUsual.bob_radius_m},
    ParameterRange{"gravity", 0.5, 30.0, kUsual.gravity_m_s2},
    ParameterRange{"latitude_deg", -90.0, 90.0, kUsual.latitude_deg},
    ParameterRange{"damping_per_s", 0.0, 1.0, kUsual.damping_per_s},
    ParameterRange{"quadratic_damping_per_rad", 0.0, 1.0, kUsual.quadratic_damping_per_rad},
    ParameterRange{"sideways_m_s", -0.5, 0.5, kUsual.sideways_m_s},
    ParameterRange{"bob_density_kg_m3", 0.0, 25000.0, kUsual.bob_density_kg_m3},
    ParameterRange{"air_density_kg_m3", 0.0, 10.0, kUsual.air_density_kg_m3},
    ParameterRange{"string_mass_kg", 0.0, 1.0, kUsual.string_mass_kg},
};

ParameterMap to_map(const PendulumParameters& p) {
    return {
        {"length_m", p.length_m},
        {"bob_radius_m", p.bob_radius_m},
        {"gravity", p.gravity_m_s2},
        {"latitude_deg", p.latitude_deg},
        {"damping_per_s", p.damping_per_s},
        {"quadratic_damping_per_rad", p.quadratic_damping_per_rad},
        {"sideways_m_s", p.sideways_m_s},
        {"bob_density_kg_m3", p.bob_density_kg_m3},
        {"air_density_kg_m3", p.air_density_kg_m3},
        {"string_mass_kg", p.string_mass_kg}};
}

double bob_mass(const PendulumParameters& p) {
    return p.bob_density_kg_m3 * 4.0 / 3.0 * std::numbers::pi * std::pow(p.bob_radius_m, 3);
}

}  // namespace

std::span<const ParameterRange> pendulum_ranges() {
    return kRanges;
}

Result<PendulumParameters> pendulum_parameters(const ParameterMap& given) {
    const auto all = complete("pendulum", kRanges, given);
    if (!all) return tl::unexpected(all.error());
    const PendulumParameters parameters{
        all->at("length_m"),
        all->at("bob_radius_m"),
        all->at("gravity"),
        all->at("latitude_deg"),
        all->at("damping_per_s"),
        all->at("quadratic_damping_per_rad"),
        all->at("sideways_m_s"),
        all->at("bob_density_kg_m3"),
        all->at("air_density_kg_m3"),
        all->at("string_mass_kg")};
    if (auto ok = check(parameters); !ok) return tl::unexpected(ok.error());
    return parameters;
}

Result<void> check(const PendulumParameters& p) {
    if (auto all = complete("pendulum", kRanges, to_map(p)); !all)
        return tl::unexpected(all.error());
    if (auto ok = check_range("bob_radius_m", p.bob_radius_m, 0.01, 0.5 * p.length_m); !ok)
        return ok;
    if (p.string_mass_kg > 0.0 && p.bob_density_kg_m3 == 0.0)
        return fail(
            ErrorCode::invalid_argument,
            "string_mass_kg",
            "is given without the bob's mass",
            "give bob_density_kg_m3, too"
        );
    if (p.air_density_kg_m3 > 0.5 * p.bob_density_kg_m3 && p.bob_density_kg_m3 > 0.0)
        return fail(
            ErrorCode::invalid_argument,
            "bob_density_kg_m3",
            "is " + shortest_text(p.bob_density_kg_m3) + ", too light for this air",
            "give at least " + shortest_text(2.0 * p.air_density_kg_m3)
        );
    return {};
}

PendulumEquation::PendulumEquation(const PendulumParameters& p)
    : damping_(p.damping_per_s), quadratic_damping_(p.quadratic_damping_per_rad) {
    const double length = p.length_m;
    const bool heavy = p.bob_density_kg_m3 > 0.0;
    const double lifted = heavy ? p.air_density_kg_m3 / p.bob_density_kg_m3 : 0.0;
    const double string = heavy ? p.string_mass_kg / bob_mass(p) : 0.0;
    const double moment = (1.0 - lifted + 0.5 * string) * length;
    const double inertia = (1.0 + 0.5 * lifted + string / 3.0) * length * length +
                           0.4 * p.bob_radius_m * p.bob_radius_m;
    const double kappa = moment / inertia;
    const double latitude = p.latitude_deg * std::numbers::pi / 180.0;
    gravity_ = {0.0, 0.0, -kappa * p.gravity_m_s2};
    earth_rate_ = kEarthRate * Eigen::Vector3d(0.0, std::cos(latitude), std::sin(latitude));
}

Eigen::Vector3d PendulumEquation::acceleration(const SwingState& s) const {
    Eigen::Vector3d pull = gravity_ - 2.0 * earth_rate_.cross(s.n_dot) - 2.0 * damping_ * s.n_dot;
    if (quadratic_damping_ > 0.0) pull -= quadratic_damping_ * s.n_dot.norm() * s.n_dot;
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
