#pragma once

#include <cstdint>
#include <span>

namespace kinectlab {

/// What is known of the scene without the objects, one value a pixel, row-major. Looks into the
/// reference that gave it.
struct SceneView {
    std::span<const float> disparity;    ///< steps; 0 = never a stable reading
    std::span<const float> variance;     ///< of the readings about it, steps²
    std::span<const std::uint8_t> seen;  ///< how many readings it rests on
};

}  // namespace kinectlab
