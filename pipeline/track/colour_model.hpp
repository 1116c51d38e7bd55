#pragma once

#include <optional>
#include <span>

#include "pipeline/features/hue.hpp"
#include "pipeline/track/colour_bounds.hpp"

namespace kinectlab {

/// Which colours a thing shows more than what stands around it.
struct ColourModel {
    ColourTable table;
    double share_inside = 0.0;   ///< of the thing's pixels that pass
    double share_outside = 0.0;  ///< of the surroundings' pixels that pass
};

/// Learns from pixels of the thing and of its surroundings. The space is hue, saturation and value
/// in cells; what is nearly grey has no hue and is told by its value alone, so that white, grey and
/// black things can be learned where what surrounds them is not. A cell passes if it is twice as
/// common inside as outside. Nothing where no colour tells the two apart.
[[nodiscard]] std::optional<ColourModel> learn_colours(
    std::span<const Hsv> inside, std::span<const Hsv> outside
);

}  // namespace kinectlab
