#include "pipeline/preprocess/voxel_change.hpp"

#include <algorithm>

namespace kinectlab {

VoxelChange::VoxelChange(const RgbdCamera& camera, const PreprocessSettings& settings)
    : camera_(camera),
      scale_(camera),
      cut_settings_(settings.depth_cut),
      voxel_m_(settings.change.voxel_m),
      least_points_(settings.change.least_points) {
    const auto pixels = static_cast<std::size_t>(camera.depth.width) *
                        static_cast<std::size_t>(camera.depth.height);
    farthest_.assign(pixels, 0.0F);
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

    const int width = camera_.depth.width;
    std::optional<DepthCut> cut;
    if (cut_settings_.method == CutMethod::wall) cut = wall_cut(reference.disparity, width);
    if (cut_settings_.method == CutMethod::fixed)
        cut = DepthCut{scale_.steps_at(cut_settings_.farthest_m), 0.0, 0.0};
    const DepthCut end = cut.value_or(DepthCut{});
    for (std::size_t i = 0; i < farthest_.size(); ++i) {
        const auto column = static_cast<double>(i % static_cast<std::size_t>(width));
        const auto row = static_cast<double>(i / static_cast<std::size_t>(width));
        farthest_[i] = std::max(reference.disparity[i], static_cast<float>(end.steps(column, row)));
    }
    return {};
}

Result<std::span<const std::uint16_t>> VoxelChange::reach(std::span<const std::uint16_t> depth) {
    const auto product = static_cast<float>(scale_.product);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const float s = depth[i] == 0 ? 0.0F : product / static_cast<float>(depth[i]);
        disparity_[i] = s > farthest_[i] ? s : 0.0F;
    }
    const auto change = reference_->changed(cloud_of(disparity_), least_points_);
    if (!change) return tl::unexpected(change.error());
    for (std::size_t i = 0; i < depth.size(); ++i)
        reach_[i] = change->mask[i] != 0 ? 65535 : 0;
    return std::span<const std::uint16_t>(reach_);
}

}  // namespace kinectlab
