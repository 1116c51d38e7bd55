#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "pipeline/core/error.hpp"
#include "pipeline/simulate/parameters.hpp"

namespace kinectlab::simulate {

/// A solid sphere on a string that it turns with. A density or mass of 0 stands for no such effect.
struct PendulumParameters {
    double length_m = 1.0;                   ///< pivot to the bob's centre; 0.2 to 3
    double bob_radius_m = 0.05;              ///< 0.01 to 0.12, and less than half the length
    double gravity_m_s2 = 9.81;              ///< 0.5 to 30
    double latitude_deg = 45.0;              ///< -90 to 90, north is positive
    double damping_per_s = 0.002;            ///< amplitude decays as exp(-damping t); 0 to 1
    double quadratic_damping_per_rad = 0.0;  ///< n'' gets -β|n'|n'; 0 to 1
    double sideways_m_s = 0.0;       ///< across the plane of the swing at the release; -0.5 to 0.5
    double bob_density_kg_m3 = 0.0;  ///< 0 to 25000
    double air_density_kg_m3 = 0.0;  ///< lifts the bob and moves with it; 0 to 10
    double string_mass_kg = 0.0;     ///< of a thin rigid rod from pivot to centre; 0 to 1
};

/// The same as an apparatus' parameters, in the order of the struct.
[[nodiscard]] std::span<const ParameterRange> pendulum_ranges();

/// Names the first parameter that is wrong as check() does, or that a pendulum has not.
[[nodiscard]] Result<PendulumParameters> pendulum_parameters(const ParameterMap& given);

/// Names the first parameter that is not a number in its range, or that needs the bob's density
/// where none is given.
[[nodiscard]] Result<void> check(const PendulumParameters& parameters);

/// Where the string points and how fast that changes, in the lab frame. |n| = 1 and n·n_dot = 0.
struct SwingState {
    Eigen::Vector3d n = -Eigen::Vector3d::UnitZ();    ///< from the pivot to the bob's centre
    Eigen::Vector3d n_dot = Eigen::Vector3d::Zero();  ///< 1/s
};

/// The equation of motion at any amplitude, in the lab frame: x east, y north, z up.
///
///   n'' = -|n'|² n + [κ g - 2 Ω×n' - 2 γ n' - β|n'|n'] without its part along n
///
/// κ = L(1 - ρ + μ/2)/(L²(1 + ρ/2 + μ/3) + 2r²/5): the bob's own inertia 2/5 m r² turns with the
/// string; ρ = ρ_air/ρ_bob is what the air lifts, half of which moves with a sphere (Stokes 1850);
/// μ is the string's mass over the bob's. Ω is the Earth's
/// turning; Lagrange's equation of the extended bob gives the Coriolis term the same inertia on
/// both sides, so it bears no κ. The centrifugal term is part of g, as everywhere on Earth.
class PendulumEquation {
public:
    explicit PendulumEquation(const PendulumParameters& parameters);

    [[nodiscard]] Eigen::Vector3d acceleration(const SwingState& state) const;

    /// One Runge-Kutta step of fourth order; the result is put back on the unit sphere.
    [[nodiscard]] SwingState step(const SwingState& state, double dt_s) const;

    /// Kinetic and potential energy over (mL² + 2/5 m r²), 1/s²; constant without damping.
    [[nodiscard]] double energy(const SwingState& state) const;

private:
    Eigen::Vector3d gravity_;     ///< κ g, 1/s²
    Eigen::Vector3d earth_rate_;  ///< rad/s
    double damping_;
    double quadratic_damping_;  ///< 1/rad
};

/// A free swing. Steps lie on a fixed grid that begins at the release, so that the motion does not
/// depend on how often it is asked for.
class Swing {
public:
    Swing(const PendulumParameters& parameters, const SwingState& start);

    /// State `t_s` after the start; times must not decrease from call to call.
    [[nodiscard]] SwingState at(double t_s);

private:
    PendulumEquation equation_;
    SwingState grid_state_;
    std::int64_t grid_steps_ = 0;
};

}  // namespace kinectlab::simulate
