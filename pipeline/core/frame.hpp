#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/core/time.hpp"

namespace kinectlab {

/// One depth picture with the colour picture nearest in time. Its camera is known to its source.
struct RgbdFrame {
    std::uint64_t index = 0;           ///< The device's own counter: a gap in it is a lost frame.
    TimeNs t = 0;                      ///< Capture of the depth picture.
    TimeNs t_colour = 0;               ///< Capture of the colour picture; 0 if there is none.
    std::vector<std::uint16_t> depth;  ///< Row-major, RgbdCamera::depth_unit_m; 0 = no reading.
    std::vector<std::uint8_t> rgb;     ///< Row-major, 3 bytes a pixel; empty if there is none.
};

}  // namespace kinectlab
