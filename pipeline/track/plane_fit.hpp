#pragma once

#include <optional>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/track/correlated_noise.hpp"
#include "pipeline/track/fitted_shape.hpp"
#include "pipeline/track/shape_pixels.hpp"

namespace kinectlab {

/// A plane refined on gathered pixels; nothing if they determine none.
[[nodiscard]] std::optional<ShapeFit> fit_plane(
    ShapePixels& pixels,
    const Pinhole& camera,
    const DisparityScale& scale,
    const Shape& guess,
    CorrelatedNoise& noise
);

/// The cost that ShapeFit::cost tells; 1 if the pixels determine no plane.
[[nodiscard]] double misfit_plane(
    ShapePixels& pixels, const DisparityScale& scale, const Shape& guess
);

}  // namespace kinectlab
