#pragma once

#include <optional>
#include <span>

namespace kinectlab {

/// Where the scene ends, in disparity, in which a plane is linear in the picture: nothing whose
/// disparity at column u, row v is below steps(u, v), which is farther, is of interest.
struct DepthCut {
    double at_origin = 0.0;   ///< steps
    double per_column = 0.0;  ///< steps a pixel; 0 for a wall across the optical axis
    double per_row = 0.0;

    [[nodiscard]] double steps(double u, double v) const {
        return at_origin + per_column * u + per_row * v;
    }
    [[nodiscard]] bool level() const { return per_column == 0.0 && per_row == 0.0; }
};

/// The pass-through cut in depth (the paper's III.B.1): the far wall's peak in the histogram of the
/// scene is cut away, and what lies behind it with it. A wall that stands slanted has no peak in
/// the histogram of depths, but it has one in the histogram of the distances from its own plane,
/// which is found by the slopes that most places of the picture share, and least squares. The peak
/// ends on its near side where it would by its far side, on which nothing can lie: so objects on
/// the wall are not cut away with it.
///
/// `disparity` in steps, 0 = no reading, rows of `width` values, which stand for every
/// `row_step`th row. Nothing is returned where no wall dominates: less than a tenth of the
/// scene in one narrow peak, more than a twentieth of it behind, or a plane that is seen at a
/// grazing angle as a floor is.
[[nodiscard]] std::optional<DepthCut> wall_cut(
    std::span<const float> disparity, int width, int row_step = 1
);

}  // namespace kinectlab
