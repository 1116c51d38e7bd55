#pragma once

#include <array>
#include <cstdint>

namespace kinectlab {

/// Where an octree's voxels lie that grows with the points it is given, as PCL 1.13's does: the
/// first point lies in the middle of one edge of the grid, and whenever a point falls outside, the
/// box doubles towards it. All of it in double precision and in PCL's order, because rounding
/// decides into which voxel a point on a boundary falls.
class OctreeBox {
public:
    explicit OctreeBox(double voxel_m) : voxel_m_(voxel_m) {}

    [[nodiscard]] bool holds(float x, float y, float z) const {
        return defined_ && x >= low_[0] && x < high_[0] && y >= low_[1] && y < high_[1] &&
               z >= low_[2] && z < high_[2];
    }
    /// Grows until it holds the point. False if that takes more than 2^kMostDepth voxels a side.
    [[nodiscard]] bool grow_to(float x, float y, float z);

    /// A point inside has the cell origin()[k] + floor((coordinate - low()[k]) / voxel); cells keep
    /// their numbers while the box grows.
    [[nodiscard]] const std::array<double, 3>& low() const { return low_; }
    [[nodiscard]] const std::array<double, 3>& high() const { return high_; }
    [[nodiscard]] const std::array<std::int32_t, 3>& origin() const { return origin_; }
    [[nodiscard]] double voxel_m() const { return voxel_m_; }

    static constexpr int kMostDepth = 19;

private:
    double voxel_m_;
    bool defined_ = false;
    int depth_ = 1;
    std::array<double, 3> low_{}, high_{};
    std::array<std::int32_t, 3> origin_{};
};

}  // namespace kinectlab
