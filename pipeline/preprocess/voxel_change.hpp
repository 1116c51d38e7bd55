#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/preprocess/octree_change.hpp"
#include "pipeline/preprocess/scene_view.hpp"
#include "pipeline/preprocess/settings.hpp"

namespace kinectlab {

/// Octree change (the paper's III.B.3) between pictures of one camera, in the form that
/// ChangeLimits has: a picture of limits. Far away a sensor's noise leaves any voxel, so that
/// voxels alone would find objects in a wall. A reading is therefore asked for its voxel only where
/// it lies before its limit: before all that the reference shows along its ray, by more than the
/// noise at that distance. What an object uncovered lies behind and is no object. Not thread-safe.
class VoxelChange {
public:
    VoxelChange(const RgbdCamera& camera, const ChangeDetectionSettings& settings);

    [[nodiscard]] Result<void> set_reference(const SceneView& reference);

    /// `limits` as ChangeLimits::reach. Changed if and only if depth - 1 < reach, in 16 bits. Valid
    /// until the next call.
    [[nodiscard]] Result<std::span<const std::uint16_t>> reach(
        std::span<const std::uint16_t> depth, std::span<const std::uint16_t> limits
    );

private:
    [[nodiscard]] Cloud cloud_of(std::span<const float> disparity) const;

    RgbdCamera camera_;
    DisparityScale scale_;
    double voxel_m_;
    int least_points_;
    std::optional<OctreeReference> reference_;
    std::vector<float> disparity_;
    std::vector<std::uint16_t> reach_;
};

}  // namespace kinectlab
