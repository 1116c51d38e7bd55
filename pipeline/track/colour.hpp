#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "colour": a pass-through filter in hue, saturation and value (the paper's III.C.2); a
/// point has the colour of the pixel where the colour camera sees it. The object is the patch of
/// continuous surface on which enough of the pixels pass, nearest to its last place, else nearest
/// in size, else the biggest. Its position is the centroid of the visible surface. Its orientation
/// is the turn of the surface's principal axes since the first frame, told only where the three
/// are clearly of different length: a ball's are not. A click or box whose colour cannot be learned
/// is a fault; what is lost says why.
///
/// Wandering brightness and white balance are taken out first, one gain for each channel by the
/// median ratio of what stands still to the first frame.
[[nodiscard]] std::unique_ptr<Tracker> make_colour_tracker(
    const RgbdCamera& camera, TrackedObjects<ColourSettings> objects
);

/// Refuses bounds outside of their ranges or empty, both or neither of bounds and box, a box
/// outside of the picture.
[[nodiscard]] Result<void> check(
    const ColourSettings& settings, const RgbdCamera& camera, const std::string& path
);

}  // namespace kinectlab
