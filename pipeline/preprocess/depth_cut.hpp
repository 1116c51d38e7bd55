#pragma once

#include <optional>
#include <span>

namespace kinectlab {

/// The pass-through cut in depth (the paper's III.B.1): the far wall's peak in the histogram of the
/// scene is cut away, and what lies behind it with it. `disparity` in steps, 0 = no reading.
/// Returns the disparity below which (farther than which) nothing is of interest; nothing where no
/// wall dominates: less than a tenth of the scene in one narrow peak, a peak that runs on towards
/// the camera (a slanted wall), or much behind it.
[[nodiscard]] std::optional<double> wall_cut_steps(std::span<const float> disparity);

}  // namespace kinectlab
