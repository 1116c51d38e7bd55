#include "pipeline/track/touched_plane.hpp"

#include <algorithm>

#include "pipeline/track/shape_search.hpp"

namespace kinectlab {
namespace {

constexpr double kReachRadii = 6.0;   // around the ball's middle
constexpr double kLeastReach = 0.15;  // m
constexpr double kMostReach = 0.40;   // m
constexpr double kOwnRadii = 1.25;    // nearer readings are the ball's
constexpr std::size_t kPoints = 600;  // that planes are tried on
constexpr int kTries = 500;
constexpr double kOnPlaneSigmas = 3.0;
constexpr std::size_t kFewest = 40;
constexpr double kRoughness = 2.0;  // times what a refined plane may be off the ball

}  // namespace

TouchedPlane::TouchedPlane(const RgbdCamera& camera) : camera_(camera.depth), scale_(camera) {}

void TouchedPlane::gather(const DisparityImage& image, const SeenBall& ball) {
    around_.clear();
    const double z = ball.centre_cam.z();
    const double reach = std::clamp(kReachRadii * ball.radius_m, kLeastReach, kMostReach);
    const Eigen::Vector2d middle = camera_.project(ball.centre_cam);
    const auto bound = [&](double value, int size) {
        return static_cast<int>(std::clamp(value, 0.0, size - 1.0));
    };
    // What is nearer to the camera than the ball looks larger.
    const double wide = camera_.fx * reach / std::max(0.1, z - reach);
    const double high = camera_.fy * reach / std::max(0.1, z - reach);
    const int left = bound(middle.x() - wide, camera_.width),
              right = bound(middle.x() + wide, camera_.width);
    const int top = bound(middle.y() - high, camera_.height),
              bottom = bound(middle.y() + high, camera_.height);
    for (int v = top; v <= bottom; ++v)
        for (int u = left; u <= right; ++u) {
            const double s = image.row(v)[u];
            if (s <= 0.0) continue;
            const Eigen::Vector3d p_cam = camera_.ray(u, v) * scale_.metres(s);
            const double away = (p_cam - ball.centre_cam).norm();
            if (away > reach || away < kOwnRadii * ball.radius_m) continue;
            around_.push_back(static_cast<std::uint32_t>(v * camera_.width + u));
        }
    const std::size_t stride = 1 + around_.size() / kPoints;
    points_.clear();
    for (std::size_t i = 0; i < around_.size(); i += stride) {
        const int u = static_cast<int>(around_[i]) % camera_.width;
        const int v = static_cast<int>(around_[i]) / camera_.width;
        points_.emplace_back(camera_.ray(u, v) * scale_.metres(image.at(around_[i])));
    }
}

/// Off the plane along the ray, in disparity, where the noise is the same everywhere.
std::size_t TouchedPlane::support(const Shape& plane) const {
    const double offset = plane.axis.dot(plane.point);
    std::size_t count = 0;
    for (const Eigen::Vector3d& p : points_) {
        const double s = scale_.steps_at(p.z());
        const double on_plane = scale_.steps_at(p.z() * offset / plane.axis.dot(p));
        count += std::abs(s - on_plane) < kOnPlaneSigmas * scale_.sigma_at(s) ? 1 : 0;
    }
    return count;
}

std::optional<Shape> TouchedPlane::find(const DisparityImage& image, const SeenBall& ball) {
    in_plane_.clear();
    gather(image, ball);
    if (points_.size() < kFewest) return std::nullopt;
    ShapeRandom random;
    Shape best;
    std::size_t most = 0;
    for (int i = 0; i < kTries; ++i) {
        const Eigen::Vector3d& a = points_[random.below(points_.size())];
        const Eigen::Vector3d& b = points_[random.below(points_.size())];
        const Eigen::Vector3d& c = points_[random.below(points_.size())];
        const Eigen::Vector3d across = (b - a).cross(c - a);
        if (across.norm() < ball.radius_m * ball.radius_m) continue;  // nearly on one line
        Shape plane;
        plane.point = a;
        plane.axis = across.normalized() * (across.dot(a) > 0.0 ? -1.0 : 1.0);
        if (std::abs(gap_between(ball, plane)) > kRoughness * most_gap(ball)) continue;
        const std::size_t count = support(plane);
        if (count <= most) continue;
        most = count;
        best = plane;
    }
    if (most < kFewest) return std::nullopt;
    const double offset = best.axis.dot(best.point);
    for (const std::uint32_t pixel : around_) {
        const double s = image.at(pixel);
        const auto width = static_cast<std::uint32_t>(camera_.width);
        const Eigen::Vector3d ray = camera_.ray(pixel % width, pixel / width);
        const double on_plane = best.axis.dot(ray) / offset / scale_.inverse_depth_step;
        if (std::abs(s - on_plane) < kOnPlaneSigmas * scale_.sigma_at(s))
            in_plane_.push_back(pixel);
    }
    return best;
}

}  // namespace kinectlab
