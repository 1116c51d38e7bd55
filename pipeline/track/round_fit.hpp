#pragma once

#include <optional>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/track/correlated_noise.hpp"
#include "pipeline/track/fitted_shape.hpp"
#include "pipeline/track/shape_pixels.hpp"

namespace kinectlab {

/// What a fit starts from.
enum class FitStart {
    guess,   ///< a rough shape
    refined  ///< a shape that was refined on some of the pixels
};

/// A sphere, cylinder or cone refined on gathered pixels; nothing if they determine none or it does
/// not settle. A fixed size stays.
[[nodiscard]] std::optional<ShapeFit> fit_round(
    ShapePixels& pixels,
    const Pinhole& camera,
    const DisparityScale& scale,
    const Shape& guess,
    FitStart start,
    bool fixed_size,
    CorrelatedNoise& noise
);

/// The cost that ShapeFit::cost tells, after a few steps from the guess; 1 if they lead nowhere.
[[nodiscard]] double misfit_round(
    ShapePixels& pixels, const Pinhole& camera, const DisparityScale& scale, const Shape& guess
);

}  // namespace kinectlab
