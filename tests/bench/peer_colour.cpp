#include "tests/bench/peer_colour.hpp"

#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace kinectlab::bench {

OpenCvColourPlace::OpenCvColourPlace(
    const RgbdCamera& camera, const std::array<int, 3>& low, const std::array<int, 3>& high
)
    : camera_(camera), low_(low), high_(high) {
    cv::setNumThreads(1);
}

std::optional<Eigen::Vector3d> OpenCvColourPlace::place(const RgbdFrame& frame) const {
    const Pinhole& k = camera_.depth;
    // The colours as the depth camera sees them: registration, which other chains get from a
    // driver.
    cv::Mat rgb(k.height, k.width, CV_8UC3, cv::Scalar(0, 0, 0));
    for (int v = 0; v < k.height; ++v)
        for (int u = 0; u < k.width; ++u) {
            const auto reading = frame.depth[static_cast<std::size_t>(v * k.width + u)];
            if (reading == 0) continue;
            const Eigen::Vector2d at = camera_.colour.project(
                camera_.T_colour_depth * (k.ray(u, v) * (camera_.depth_unit_m * reading))
            );
            const auto column = static_cast<int>(std::lround(at.x()));
            const auto row = static_cast<int>(std::lround(at.y()));
            if (column < 0 || row < 0 || column >= camera_.colour.width ||
                row >= camera_.colour.height)
                continue;
            const auto* p = frame.rgb.data() +
                            3 * static_cast<std::size_t>(row * camera_.colour.width + column);
            rgb.at<cv::Vec3b>(v, u) = cv::Vec3b(p[0], p[1], p[2]);
        }
    cv::Mat hsv, mask, labels, stats, centroids;
    cv::cvtColor(rgb, hsv, cv::COLOR_RGB2HSV);
    cv::inRange(
        hsv, cv::Scalar(low_[0], low_[1], low_[2]), cv::Scalar(high_[0], high_[1], high_[2]), mask
    );
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 4);
    int biggest = 0;
    for (int i = 1; i < count; ++i)
        if (biggest == 0 ||
            stats.at<int>(i, cv::CC_STAT_AREA) > stats.at<int>(biggest, cv::CC_STAT_AREA))
            biggest = i;
    if (biggest == 0) return std::nullopt;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int points = 0;
    for (int v = 0; v < k.height; ++v)
        for (int u = 0; u < k.width; ++u) {
            if (labels.at<int>(v, u) != biggest) continue;
            sum += k.ray(u, v) *
                   (camera_.depth_unit_m * frame.depth[static_cast<std::size_t>(v * k.width + u)]);
            ++points;
        }
    return Eigen::Vector3d(sum / points);
}

}  // namespace kinectlab::bench
