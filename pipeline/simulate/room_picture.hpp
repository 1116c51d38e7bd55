#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/simulate/scene.hpp"

namespace kinectlab::simulate {

/// The empty room as a colour camera sees it, with smooth edges: width x height x 3 bytes, sRGB.
/// Costs a good part of a second.
[[nodiscard]] std::vector<std::uint8_t> picture_of_room(
    const Room& room, const Pinhole& camera, const Eigen::Isometry3d& T_lab_colour
);

}  // namespace kinectlab::simulate
