#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace kinectlab {

/// A point of a surface with a value on it, e.g. its brightness from 0 to 1.
struct ValuedPoint {
    Eigen::Vector3f p_cam = Eigen::Vector3f::Zero();  ///< m
    float value = 0.0F;
};

/// The occupied voxels of a cloud, structure of arrays, ordered by layer, row and column: a row is
/// a range of indices, and neighbours are found by walking rows side by side, without a tree.
struct VoxelSurface {
    struct Row {
        std::int32_t y = 0, z = 0;  ///< in voxels
        std::uint32_t first = 0;    ///< index of its first voxel; the next row's ends it
    };
    float voxel_m = 0.0F;
    std::vector<std::int32_t> x;         ///< column of each voxel
    std::vector<float> value;            ///< mean of its points
    std::vector<Eigen::Vector3f> p_cam;  ///< mean of its points, m
    std::vector<Row> rows;               ///< and one past the end

    [[nodiscard]] std::size_t size() const { return x.size(); }
    [[nodiscard]] std::size_t row_count() const { return rows.empty() ? 0 : rows.size() - 1; }
};

/// Voxels of side `voxel_m` > 0. Points that are not finite, or farther than 2^20 voxels from the
/// origin in a coordinate, are left out; an empty cloud gives no voxels. Points in the order of a
/// picture are sorted soonest, any order is right.
[[nodiscard]] VoxelSurface voxelise(std::span<const ValuedPoint> points, float voxel_m);

/// The same surface in voxels of twice the side, each the mean of those in it.
[[nodiscard]] VoxelSurface halved(const VoxelSurface& fine);

/// For each voxel the indices of its up to 26 occupied neighbours.
struct VoxelNeighbours {
    static constexpr std::size_t kMost = 26;
    std::vector<std::uint32_t> indices;  ///< kMost for each voxel
    std::vector<std::uint8_t> counts;

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t voxel) const {
        return {indices.data() + voxel * kMost, counts[voxel]};
    }
};
[[nodiscard]] VoxelNeighbours neighbours_of(const VoxelSurface& surface);

/// Rows beside a row, for walking a surface: calls visit(row, other, dy, dz) for every pair of rows
/// no more than `reach` voxels apart across, each row in order, itself included.
template <class Visit>
void for_each_row_pair(const VoxelSurface& surface, int reach, Visit&& visit) {
    struct Offset {
        std::int32_t dy, dz;
        std::size_t at;
    };
    std::vector<Offset> offsets;
    for (std::int32_t dz = -reach; dz <= reach; ++dz)
        for (std::int32_t dy = -reach; dy <= reach; ++dy)
            if (dy * dy + dz * dz <= reach * reach) offsets.push_back({dy, dz, 0});
    const std::size_t count = surface.row_count();
    for (std::size_t row = 0; row < count; ++row) {
        const auto& own = surface.rows[row];
        // Rows are ordered, so each offset's other row only ever moves on.
        for (auto& offset : offsets) {
            const std::int32_t y = own.y + offset.dy, z = own.z + offset.dz;
            const auto is_before = [&](const VoxelSurface::Row& other) {
                return other.z < z || (other.z == z && other.y < y);
            };
            while (offset.at < count && is_before(surface.rows[offset.at]))
                ++offset.at;
            if (offset.at == count) continue;
            const auto& other = surface.rows[offset.at];
            if (other.y == y && other.z == z) visit(row, offset.at, offset.dy, offset.dz);
        }
    }
}

}  // namespace kinectlab
