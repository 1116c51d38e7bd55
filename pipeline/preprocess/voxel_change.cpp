#include "pipeline/preprocess/voxel_change.hpp"

namespace kinectlab {

VoxelChange::VoxelChange(const RgbdCamera& camera, const ChangeDetectionSettings& settings)
    : camera_(camera),
      scale_(camera),
      voxel_m_(settings.voxel_m),
      least_points_(settings.least_points) {
    const auto pixels = static_cast<std::size_t>(camera.depth.width) *
                        static_cast<std::size_t>(camera.depth.height);
    disparity_.assign(pixels, 0.0F);
    reach_.assign(pixels, 0);
}

Cloud VoxelChange::cloud_of(std::span<const float> disparity) const {
    const Pinhole& lens = camera_.depth;
    Cloud cloud = blank_cloud(lens.width, lens.height);
    std::size_t i = 0;
    for (int v = 0; v < lens.height; ++v)
        for (int u = 0; u < lens.width; ++u, ++i) {
            if (!(disparity[i] > 0.0F)) continue;
            const Eigen::Vector3d p_cam = scale_.metres(disparity[i]) * lens.ray(u, v);
            cloud.x[i] = static_cast<float>(p_cam.x());
            cloud.y[i] = static_cast<float>(p_cam.y());
            cloud.z[i] = static_cast<float>(p_cam.z());
        }
    return cloud;
}

Result<void> VoxelChange::set_reference(const SceneView& reference) {
    auto made = OctreeReference::of(cloud_of(reference.disparity), voxel_m_);
    if (!made) return tl::unexpected(made.error());
    reference_ = std::move(*made);
    return {};
}

Result<std::span<const std::uint16_t>> VoxelChange::reach(
    std::span<const std::uint16_t> depth, std::span<const std::uint16_t> limits
) {
    const auto product = static_cast<float>(scale_.product);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const bool before = static_cast<std::uint16_t>(depth[i] - 1) < limits[i];
        disparity_[i] = before ? product / static_cast<float>(depth[i]) : 0.0F;
    }
    const auto change = reference_->changed(cloud_of(disparity_), least_points_);
    if (!change) return tl::unexpected(change.error());
    for (std::size_t i = 0; i < depth.size(); ++i)
        reach_[i] = change->mask[i] != 0 ? 65535 : 0;
    return std::span<const std::uint16_t>(reach_);
}

}  // namespace kinectlab
