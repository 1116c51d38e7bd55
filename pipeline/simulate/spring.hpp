#pragma once

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// A ball on a vertical, massless spring whose other end a drive can move up and down from the
/// release on, by A sin(2πft). y counts upwards from the place of rest, which lies at 1.10 m
/// whatever the spring: the string above it is made to measure.
///
///   y'' = (k/m)(A sin(2πft) - y) - 2γ y'
///
/// Gravity stretches the spring and does nothing else; it is a parameter because people expect it.
/// Stopped the ball is wound up out of the picture. Value: m below rest, -0.3 to 0.3. A drive that
/// would swing the ball by more than 0.4 m in the end is refused.
///
/// | parameter | range | usual |
/// | stiffness_n_m | 1 to 200 | 10 |
/// | mass_kg | 0.05 to 2 | 0.25 |
/// | ball_radius_m | 0.02 to 0.06 | 0.04 |
/// | damping_per_s, amplitude decays as exp(-damping t) | 0 to 2 | 0.05 |
/// | gravity, m/s² | 0.5 to 30 | 9.81 |
/// | drive_hz | 0 to 5 | 0 |
/// | drive_amplitude_m | 0 to 0.1 | 0 |
[[nodiscard]] Result<std::unique_ptr<Apparatus>> make_spring(const ParameterMap& given);
[[nodiscard]] std::span<const ParameterRange> spring_ranges();

}  // namespace kinectlab::simulate
