#pragma once

#include <vector>

#include "pipeline/track/shape_search.hpp"

namespace kinectlab {

/// The Hough transform, the alternative that the paper names beside RANSAC: every oriented point
/// votes for the shapes that it may lie on, and what gathers most votes is a candidate. Nothing is
/// drawn at random, so the result is the same however few points belong to the shape; the memory
/// and time of the votes grow with the space that is searched. Best first, at most `most`, each
/// with the points that hold for it as support. Empty if there are fewer than 8 points.

/// Planes n·p = d: a point votes for the directions within reach of its normal, at d = n·p.
void hough_planes(
    const SurfacePoints& points,
    const Tolerance& tolerance,
    std::size_t most,
    std::vector<ShapeCandidate>& best
);

/// Spheres of a known radius or of radii within limits: a point votes for the centres along its
/// normal's line behind it, one for each radius.
void hough_spheres(
    const SurfacePoints& points,
    const SizeLimits& limits,
    const Tolerance& tolerance,
    std::size_t most,
    std::vector<ShapeCandidate>& best
);

}  // namespace kinectlab
