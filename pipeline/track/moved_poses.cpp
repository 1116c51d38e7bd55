#include "pipeline/track/moved_poses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinectlab {
namespace {

constexpr std::size_t kFewestReadings = 40;
constexpr int kRolls = 16;

/// Median of each coordinate: a few readings of what lies behind do not move it.
Eigen::Vector3f middle_of(std::vector<Eigen::Vector3f>& points) {
    Eigen::Vector3f middle;
    const auto half = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
    for (int axis = 0; axis < 3; ++axis) {
        std::nth_element(
            points.begin(),
            half,
            points.end(),
            [axis](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a[axis] < b[axis]; }
        );
        middle[axis] = (*half)[axis];
    }
    return middle;
}

}  // namespace

std::vector<ViewPose> moved_poses(
    std::span<const std::uint16_t> depth,
    const RgbdCamera& camera,
    std::span<const std::uint32_t> pixels,
    const PatchTable& table
) {
    std::vector<Eigen::Vector3f> points;
    points.reserve(pixels.size());
    for (const auto pixel : pixels) {
        if (depth[pixel] == 0) continue;
        const auto column = static_cast<int>(pixel) % camera.depth.width;
        const auto row = static_cast<int>(pixel) / camera.depth.width;
        const double z = depth[pixel] * camera.depth_unit_m;
        points.emplace_back((camera.depth.ray(column, row) * z).cast<float>());
    }
    std::vector<ViewPose> poses;
    if (points.size() < kFewestReadings) return poses;
    const Eigen::Vector3f middle = middle_of(points);
    const auto sight =
        Eigen::Quaternionf::FromTwoVectors(Eigen::Vector3f::UnitZ(), middle.normalized());

    std::vector<Eigen::Vector3f> shown;
    for (std::uint32_t view = 0; view < table.views(); ++view) {
        const SketchView& sketch = table.view(view);
        if (sketch.surface.empty()) continue;
        shown.clear();
        for (const auto& point : sketch.surface)
            shown.push_back(sketch.R_cam_obj * point.p_obj);
        const Eigen::Vector3f middle_shown = middle_of(shown);
        for (int roll = 0; roll < kRolls; ++roll) {
            const float angle =
                2.0F * std::numbers::pi_v<float> * static_cast<float>(roll) / kRolls;
            const Eigen::Quaternionf turned =
                sight * Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ());
            Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
            T.linear() = turned.toRotationMatrix() * sketch.R_cam_obj;
            T.translation() = middle - turned * middle_shown;
            poses.push_back({T, view});
        }
    }
    return poses;
}

}  // namespace kinectlab
