#pragma once

#include <cstdint>

namespace kinectlab {

/// A spot of a picture that can be found again.
struct Keypoint2d {
    float u = 0.0F, v = 0.0F;  ///< px, sub-pixel, of the whole picture
    float scale_px = 0.0F;     ///< σ of the blur at which it stands out, in the picture's pixels
    float angle_rad = 0.0F;    ///< of the dominant gradient, from u towards v
    float response = 0.0F;     ///< how clearly it stands out; positive
    float x = 0.0F, y = 0.0F;  ///< px, in its octave or level
    std::uint8_t octave = 0;
    std::uint8_t layer = 0;
};

}  // namespace kinectlab
