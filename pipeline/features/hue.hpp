#pragma once

#include <algorithm>

namespace kinectlab {

/// Hue, saturation and value of a colour (Smith 1978).
struct Hsv {
    float hue_deg = 0.0F;     ///< 0 to 360: red 0, green 120, blue 240; 0 for grey
    float saturation = 0.0F;  ///< 0 grey to 1
    float value = 0.0F;       ///< 0 black to 1
};

/// From red, green and blue, each 0 to 1. Hue and saturation do not change with brightness.
[[nodiscard]] inline Hsv hsv_of(float r, float g, float b) {
    const float high = std::max({r, g, b}), low = std::min({r, g, b});
    const float chroma = high - low;
    if (high <= 0.0F || chroma <= 0.0F) return {0.0F, 0.0F, std::max(0.0F, high)};
    float sixth = 0.0F;
    if (high == r)
        sixth = (g - b) / chroma;
    else if (high == g)
        sixth = 2.0F + (b - r) / chroma;
    else
        sixth = 4.0F + (r - g) / chroma;
    return {60.0F * (sixth < 0.0F ? sixth + 6.0F : sixth), chroma / high, high};
}

}  // namespace kinectlab
