#pragma once

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// A box of uniform density on an air bearing: it turns about its centre at (0, 0, 1.12) m, free of
/// torque. At the release a motor has given it rates about its own axes.
///
///   I w' = (I w) × w in the body's frame, I = m/12 diag(b² + c², c² + a², a² + b²)
///
/// It is held so that three faces show, with a slight turn about each axis. Value: 0.
///
/// | parameter | range | usual |
/// | size_a_m, size_b_m, size_c_m along x, y, z | 0.04 to 0.3 | 0.20, 0.14, 0.08 |
/// | rate_x_deg_s, rate_y_deg_s, rate_z_deg_s | -360 to 360 | 10, 60, 5 |
[[nodiscard]] Result<std::unique_ptr<Apparatus>> make_tumbler(const ParameterMap& given);
[[nodiscard]] std::span<const ParameterRange> tumbler_ranges();

}  // namespace kinectlab::simulate
