#pragma once

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// A solid ball on a plank of 1.30 x 0.30 m that falls towards +x; the plank's lower end lies at
/// 0.56 m, and a stop there catches the ball, which then rests against it, free. No table.
///
///   rolling: s'' = 5/7 g (sin α - c cos α) where the friction that this takes is at most μ,
///            without drag: 2/7 tan α ≤ μ
///   sliding: s'' = g (sin α - μ cos α), while r ω' = 5/2 g cos α (μ - c)
///
/// Steeper drag than slope, c ≥ tan α, keeps the ball where it is. Value: m down the plank from the
/// start, 0 to 0.6.
///
/// | parameter | range | usual |
/// | incline_deg | 1 to 30 | 8 |
/// | ball_radius_m | 0.02 to 0.06 | 0.035 |
/// | friction, Coulomb's μ | 0 to 2 | 0.3 |
/// | rolling_drag, c: a torque c N r against the turning | 0 to 0.2 | 0 |
/// | gravity, m/s² | 0.5 to 30 | 9.81 |
[[nodiscard]] Result<std::unique_ptr<Apparatus>> make_incline(const ParameterMap& given);
[[nodiscard]] std::span<const ParameterRange> incline_ranges();

}  // namespace kinectlab::simulate
