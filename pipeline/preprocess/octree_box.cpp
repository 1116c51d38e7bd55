#include "pipeline/preprocess/octree_box.hpp"

#include <limits>

namespace kinectlab {

bool OctreeBox::grow_to(float x, float y, float z) {
    constexpr float kMargin = std::numeric_limits<float>::epsilon();
    const std::array<float, 3> point{x, y, z};
    if (!defined_) {
        // One voxel about the point, then widened to the two of a tree of depth 1.
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k] = point[k] - voxel_m_ / 2;
            high_[k] = point[k] + voxel_m_ / 2;
            const double widen = (2.0 * voxel_m_ - (high_[k] - low_[k])) / 2.0;
            if (widen > kMargin) {
                low_[k] -= widen;
                high_[k] += widen;
            }
        }
        defined_ = true;
    }
    while (!holds(x, y, z)) {
        if (depth_ == kMostDepth) return false;
        const auto cells = std::int32_t{1} << depth_;
        const double side = cells * voxel_m_;
        ++depth_;
        const double new_side = 2 * cells * voxel_m_ - kMargin;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(point[k] >= high_[k])) {
                low_[k] -= side;
                origin_[k] -= cells;
            }
        }
        for (std::size_t k = 0; k < 3; ++k)
            high_[k] = low_[k] + new_side;
    }
    return true;
}

}  // namespace kinectlab
