#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/core/cloud.hpp"
#include "pipeline/preprocess/octree_box.hpp"
#include "pipeline/preprocess/voxel_set.hpp"

namespace kinectlab {

struct OctreeChange {
    std::vector<std::uint8_t> mask;  ///< 1 = in a voxel that was empty; as many as points
    std::size_t count = 0;
};

/// Change detection against a reference cloud for clouds from anywhere (the paper's III.B.3): a
/// point has changed if its voxel holds no point of the reference. Voxels are aligned as in PCL
/// 1.13's OctreePointCloudChangeDetector, so that the same points are found.
/// Points without a reading are passed over. Thread-safe once made.
class OctreeReference {
public:
    /// Errors: a voxel that is not a positive number; a cloud that spans 2^19 voxels or more;
    /// arrays that do not fit width x height. Against an empty reference everything has changed.
    [[nodiscard]] static Result<OctreeReference> of(const Cloud& reference, double voxel_m);

    /// Only voxels with at least `least_points` points of this cloud count; 1 or more.
    [[nodiscard]] Result<OctreeChange> changed(const Cloud& cloud, int least_points = 1) const;

    /// How many voxels the reference occupies.
    [[nodiscard]] std::size_t voxels() const { return occupied_.size(); }

private:
    explicit OctreeReference(double voxel_m) : box_(voxel_m) {}

    OctreeBox box_;
    VoxelSet occupied_;
};

}  // namespace kinectlab
