#pragma once

#include "pipeline/core/track_sample.hpp"
#include "pipeline/track/shape_pixels.hpp"

namespace kinectlab {

/// How well a shape explains the pixels it was last linearised at.
struct ShapeQuality {
    TrackQuality quality;
    double cost = 1.0;  ///< as ShapeFit's
};
[[nodiscard]] ShapeQuality judge_fit(const ShapePixels& pixels, double gate_steps);

/// Of the pixels that are used now and were not chosen before.
struct RimSums {
    double pixels = 0.0;
    double squares = 0.0;  ///< of residuals, steps²; what is beyond the gate counts as the gate
};
[[nodiscard]] RimSums sum_rim(const ShapePixels& pixels, double gate_steps);

}  // namespace kinectlab
