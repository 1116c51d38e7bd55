#include <chrono>
#include <cmath>

#include "pipeline/features/two_cameras.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_sift3d.hpp"
#include "tests/unit/pipeline/support/textured_scene.hpp"

namespace kinectlab::bench {
namespace {

using test::PrintedBox;
using test::TexturedScene;

double now_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch()
    )
        .count();
}

std::vector<ValuedPoint> points_of(const RgbdCamera& camera, const RgbdFrame& frame) {
    const TwoCameras cameras(camera);
    const int width = camera.depth.width;
    std::vector<std::int32_t> row(static_cast<std::size_t>(width));
    std::vector<ValuedPoint> points;
    for (int v = 0; v < camera.depth.height; ++v) {
        const auto first = static_cast<std::size_t>(v * width);
        cameras.colour_indices(&frame.depth[first], 0, v, width, row.data());
        for (int u = 0; u < width; ++u) {
            const std::int32_t at = row[static_cast<std::size_t>(u)];
            if (at < 0) continue;
            const auto* rgb = frame.rgb.data() + 3 * static_cast<std::ptrdiff_t>(at);
            const double z = frame.depth[first + static_cast<std::size_t>(u)] * camera.depth_unit_m;
            points.push_back(
                {(camera.depth.ray(u, v) * z).cast<float>(),
                 (0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2]) / 255.0F}
            );
        }
    }
    return points;
}

std::vector<PrintedBox> two_boxes(double moved) {
    std::vector<PrintedBox> boxes(2);
    for (std::size_t i = 0; i < 2; ++i) {
        const double side = i == 0 ? -1.0 : 1.0;
        boxes[i].print = static_cast<std::uint32_t>(i + 1);
        boxes[i].half_m = {0.08, 0.11, 0.04};
        boxes[i].T_cam_box.translation() << 0.18 * side + 0.04 * moved, 0.02, 1.0 + 0.04 * moved;
        const Eigen::Vector3d axis = Eigen::Vector3d(0.1, 1.0, 0.2).normalized();
        boxes[i].T_cam_box.linear() =
            Eigen::AngleAxisd(side * (0.1 + 0.1 * moved), axis).toRotationMatrix();
    }
    return boxes;
}

/// Share of the first frame's spots on the boxes that the second has within a scale of where the
/// box took them.
double repeatability(
    const std::vector<Eigen::Vector3f>& first,
    const std::vector<Eigen::Vector3f>& second,
    double near_m
) {
    const auto then = two_boxes(0.0), now = two_boxes(1.0);
    int asked = 0, found = 0;
    for (const auto& spot : first)
        for (std::size_t i = 0; i < 2; ++i) {
            const Eigen::Vector3d p_box = then[i].T_cam_box.inverse() * spot.cast<double>();
            if (((p_box.cwiseAbs() - then[i].half_m).array() > 0.01).any()) continue;
            const Eigen::Vector3f at = (now[i].T_cam_box * p_box).cast<float>();
            ++asked;
            for (const auto& other : second)
                if ((other - at).norm() < near_m) {
                    ++found;
                    break;
                }
        }
    return asked > 0 ? static_cast<double>(found) / asked : 0.0;
}

}  // namespace

Figures measure_sift3d_keypoints() {
    TexturedScene scene(5);
    scene.wall_m = 1.6;
    const RgbdFrame frame_a = scene.frame(two_boxes(0.0)), frame_b = scene.frame(two_boxes(1.0));
    const auto a = points_of(scene.camera, frame_a), b = points_of(scene.camera, frame_b);
    const Sift3dSettings settings;
    const auto own = [&](const std::vector<ValuedPoint>& points) {
        std::vector<Eigen::Vector3f> places;
        const auto octaves = surface_scale_space(points, settings);
        for (const auto& keypoint : sift3d_keypoints(octaves, settings))
            places.push_back(keypoint.p_cam);
        return places;
    };
    double own_ms = 1e9;
    for (int i = 0; i < 5; ++i) {
        const double start = now_ms();
        (void)own(a);
        own_ms = std::min(own_ms, now_ms() - start);
    }
    const double start = now_ms();
    const auto peer_a = pcl_sift3d_keypoints(a, settings);
    const double peer_ms = now_ms() - start;
    const auto peer_b = pcl_sift3d_keypoints(b, settings);
    const double near_m = settings.smallest_scale_m;
    const double peer_again = repeatability(peer_a, peer_b, near_m);
    const std::string pcl = "PCL SIFTKeypoint";
    return {
        {"3-D SIFT keypoints, whole frame",
         own_ms,
         "ms",
         peer_ms / 20,
         Better::lower,
         peer_ms,
         pcl},
        {"3-D SIFT keypoints: repeatability",
         repeatability(own(a), own(b), near_m),
         "1",
         peer_again,
         Better::higher,
         peer_again,
         pcl},
    };
}

}  // namespace kinectlab::bench
