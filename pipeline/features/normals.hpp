#pragma once

#include <vector>

#include "pipeline/core/cloud.hpp"

namespace kinectlab {

struct NormalSettings {
    /// The plane is fitted to (2 half_window + 1)² pixels, 1 to kMostHalfWindow.
    int half_window = 8;
    /// Readings belong to one surface if their inverse depths differ by no more than this, 1/m, or
    /// by max_jump_share of the inverse depth itself: eight steps of a Kinect's disparity.
    double max_jump_per_m = 8 * 2.85e-3;
    double max_jump_share = 0.015;

    static constexpr int kMostHalfWindow = 16;
};

/// Unit normals towards the camera, camera frame, row-major; NaN where there is none.
struct NormalImage {
    int width = 0;
    int height = 0;
    std::vector<float> x, y, z;
};

/// Normals of a whole picture, each from the plane of least squares through its window. A plane is
/// linear in the picture in inverse depth, 1/z = a u + b v + c, and there the noise is the same
/// everywhere; so the fit is three sums. Where the window holds nothing but one surface these are
/// the same for all pixels and taken along rows and columns in turn; elsewhere only the neighbours
/// that continue the pixel's own surface are summed.
/// A point without a reading, or with less than a quarter of its window on its own surface, has no
/// normal. `cloud` in the camera's frame, z forward; readings that are not are ignored.
/// Errors: settings out of range; a cloud that is not the camera's width x height.
[[nodiscard]] Result<NormalImage> find_normals(
    const Cloud& cloud, const Pinhole& camera, const NormalSettings& settings = {}
);

}  // namespace kinectlab
