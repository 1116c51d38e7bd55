#pragma once

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// A ball that a launcher throws in the plane y = 0 from (-0.70, 0, 1.45) m towards +x, or drops.
///
///   v' = -g z - (3/8) Cd ρ_air/(ρ_ball r) |v| v
///
/// Quadratic drag only: neither buoyancy nor added mass nor Magnus. A tray of sand catches it,
/// its top at 0.52 m within |x| ≤ 0.85 m, else the floor; there it rests, free, until it is
/// stopped. No table. Value: 0.
///
/// | parameter | range | usual |
/// | ball_radius_m | 0.015 to 0.06 | 0.03 |
/// | ball_density_kg_m3 | 20 to 20000 | 900 |
/// | speed_m_s, at the release | 0 to 4 | 2.2 |
/// | elevation_deg | -80 to 90 | 45 |
/// | gravity, m/s² | 0.5 to 30 | 9.81 |
/// | air_density_kg_m3 | 0 to 10 | 1.2 |
/// | drag_coefficient | 0 to 2 | 0.47 |
[[nodiscard]] Result<std::unique_ptr<Apparatus>> make_projectile(const ParameterMap& given);
[[nodiscard]] std::span<const ParameterRange> projectile_ranges();

}  // namespace kinectlab::simulate
