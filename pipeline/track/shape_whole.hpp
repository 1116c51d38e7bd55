#pragma once

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/fitted_shape.hpp"

namespace kinectlab {

/// Whether a sphere, cylinder or cone stands in the picture as a whole, between the ends that are
/// seen of it, and not only where its pixels were found. Among the rays that meet it, inside its
/// outline, those that read it speak for it and those that read something behind it against it: it
/// would hide that. Nor may much of it be sunk in a surface just before it, as a bulge that goes on
/// as a flat face is (0.4 and more, cans and mugs up to 0.04). What stands farther before it and
/// what has no reading says nothing. So a bulging lid, a bent face or a rounded corner, each of
/// which a ball, can or cone fits within the noise, is none of these. A plane has no outline and is
/// always whole.
[[nodiscard]] bool is_whole(
    const ShapeFit& fit,
    const DisparityImage& image,
    const Pinhole& camera,
    const DisparityScale& scale,
    double most_rays = 2500.0,
    double most_sunk = 0.2
);

}  // namespace kinectlab
