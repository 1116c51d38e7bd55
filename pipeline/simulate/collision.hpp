#pragma once

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// Two smooth balls that float over a level air table, without friction or spin, their centres at
/// the same height of 0.75 m + the larger radius. At the release A is pushed from (-0.62, 0) m
/// towards +x; B rests at (0.08, offset_m). What they have of speed along the line of their centres
/// is exchanged when they touch:
///
///   u = v_A·n, along n from A to B; A loses (1 + e) m_B/(m_A + m_B) u, B gains (1 + e) m_A/(m_A +
///   m_B) u
///
/// A ball is caught where it reaches the table's border, |x| = 0.74 or |y| = 0.34 m, and rests
/// there, free. The arm brings A into the picture first. Value: 0. An offset beside which A passes
/// B is refused.
///
/// | parameter | range | usual |
/// | mass_a_kg, mass_b_kg | 0.02 to 2 | 0.3, 0.2 |
/// | radius_a_m, radius_b_m | 0.025 to 0.06 | 0.05, 0.035 |
/// | speed_m_s | 0.05 to 1.5 | 0.5 |
/// | restitution, e | 0 to 1 | 0.9 |
/// | offset_m, of B towards +y | -0.1 to 0.1 | 0 |
[[nodiscard]] Result<std::unique_ptr<Apparatus>> make_collision(const ParameterMap& given);
[[nodiscard]] std::span<const ParameterRange> collision_ranges();

}  // namespace kinectlab::simulate
