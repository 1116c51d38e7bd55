#pragma once

#include "pipeline/core/camera.hpp"
#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab::bench {

/// The Cramér-Rao bound of a ball, can or cone from one depth picture: no unbiased estimate can
/// have smaller variances. From numerical differences of the disparity that every pixel's ray
/// meets; shares nothing with the tracker. Independent Gaussian errors in disparity, size unknown.
/// The ends and the rim are left out as regular_centre_bound() does for a sphere: pixels that show
/// the round face whatever the place is, as far as the noise leaves it open.
struct ShapeBound {
    double place_m = 0.0;  ///< root of the sum of variances of the shown directions; a can's at its
                           ///< middle, a cone's at its apex
    double axis_rad = 0.0;  ///< of both tilts together
    double size = 0.0;      ///< of radius (m) or angle (rad)
};
[[nodiscard]] ShapeBound shape_bound(const RgbdCamera& camera, const test::Solid& solid);

}  // namespace kinectlab::bench
