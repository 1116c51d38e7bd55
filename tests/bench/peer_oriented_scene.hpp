#pragma once

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "tests/bench/oriented_points.hpp"

namespace kinectlab::bench {

/// Every second pixel of each second row with PCL's normal of the points within 2 cm, towards the
/// camera: narrower ones are noise on a Kinect. Pixels without a reading or normal are left out,
/// and whatever lies behind `farthest_m` or below `lowest_m` (y, downwards).
[[nodiscard]] OrientedPoints oriented_scene(
    const RgbdCamera& camera, const RgbdFrame& frame, double farthest_m, double lowest_m
);

}  // namespace kinectlab::bench
