#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/preprocess/depth_cut.hpp"
#include "pipeline/preprocess/octree_change.hpp"
#include "pipeline/preprocess/scene_view.hpp"
#include "pipeline/preprocess/settings.hpp"

namespace kinectlab {

/// Octree change (the paper's III.B.3) between pictures of one camera, in the form that
/// ChangeLimits has: a picture of limits. Where the reference was seen nearer than a point, the
/// point is what an object uncovered and not an object. Not thread-safe.
class VoxelChange {
public:
    VoxelChange(const RgbdCamera& camera, const PreprocessSettings& settings);

    [[nodiscard]] Result<void> set_reference(const SceneView& reference);

    /// Changed if and only if depth - 1 < reach, in 16 bits. Valid until the next call.
    [[nodiscard]] Result<std::span<const std::uint16_t>> reach(std::span<const std::uint16_t> depth
    );

private:
    [[nodiscard]] Cloud cloud_of(std::span<const float> disparity) const;

    RgbdCamera camera_;
    DisparityScale scale_;
    DepthCutSettings cut_settings_;
    double voxel_m_;
    int least_points_;
    std::optional<DepthCut> cut_;
    std::optional<OctreeReference> reference_;
    std::vector<float> farthest_;  // disparity beyond which nothing counts
    std::vector<float> disparity_;
    std::vector<std::uint16_t> reach_;
};

}  // namespace kinectlab
