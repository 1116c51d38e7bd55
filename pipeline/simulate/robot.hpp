#pragma once

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// A box-shaped robot on the table that drives a closed course again and again: 0.5 m straight
/// towards +x, an arc of 180° to the left of radius R, 0.5 m straight back, a turn of 90° to the
/// left in place, 2R straight, and a turn of 90° to the left. It turns at its turning rate, on the
/// arc as well, where it drives as fast as R allows: R = speed/rate, but from 0.05 to 0.14 m. It
/// changes its speed at once. Held it stands, and drives on where it was. Value: 0.
///
/// Its frame: origin at the centre of the box, x ahead, y to its left, z up.
///
/// | parameter | range | usual |
/// | speed_m_s | 0.02 to 0.5 | 0.15 |
/// | turning_deg_s | 5 to 180 | 60 |
/// | length_m, along x | 0.06 to 0.25 | 0.16 |
/// | width_m | 0.06 to 0.25 | 0.10 |
/// | height_m | 0.05 to 0.25 | 0.12 |
[[nodiscard]] Result<std::unique_ptr<Apparatus>> make_robot(const ParameterMap& given);
[[nodiscard]] std::span<const ParameterRange> robot_ranges();

}  // namespace kinectlab::simulate
