#include "pipeline/features/normal.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace kinectlab {

std::optional<OrientedPoint> oriented_point(
    std::span<const std::uint16_t> depth,
    const Pinhole& camera,
    const DisparityScale& scale,
    std::uint32_t pixel,
    int half_window,
    double max_jump_steps
) {
    const int u = static_cast<int>(pixel) % camera.width;
    const int v = static_cast<int>(pixel) / camera.width;
    const std::uint16_t centre = depth[pixel];
    if (centre == 0) return std::nullopt;
    const double s0 = scale.steps(centre);

    // Least squares of s = s0 + a·du + b·dv + c over the window: its six moments, and s with each.
    double n = 0, mu = 0, mv = 0, muu = 0, muv = 0, mvv = 0, ms = 0, msu = 0, msv = 0;
    const int left = std::max(-half_window, -u);
    const int right = std::min(half_window, camera.width - 1 - u);
    const int top = std::max(-half_window, -v);
    const int bottom = std::min(half_window, camera.height - 1 - v);
    for (int dv = top; dv <= bottom; ++dv) {
        const auto* row = depth.data() + static_cast<std::ptrdiff_t>(v + dv) * camera.width + u;
        for (int du = left; du <= right; ++du) {
            if (row[du] == 0) continue;
            const double s = scale.steps(row[du]) - s0;
            if (std::abs(s) > max_jump_steps) continue;
            n += 1, mu += du, mv += dv, muu += du * du, muv += du * dv, mvv += dv * dv;
            ms += s, msu += s * du, msv += s * dv;
        }
    }
    const int side = 2 * half_window + 1;
    if (2 * n < side * side) return std::nullopt;
    Eigen::Matrix3d moments;
    moments << muu, muv, mu, muv, mvv, mv, mu, mv, n;
    const Eigen::Vector3d slope = moments.inverse() * Eigen::Vector3d(msu, msv, ms);

    // s = k·(n/d)·((u-cx)/fx, (v-cy)/fy, 1) compared with the slopes in the picture.
    const Eigen::Vector3d ray = camera.ray(u, v);
    Eigen::Vector3d normal(slope.x() * camera.fx, slope.y() * camera.fy, 0.0);
    const double s = s0 + slope.z();
    normal.z() = s - normal.x() * ray.x() - normal.y() * ray.y();
    if (!normal.allFinite() || normal.squaredNorm() == 0.0) return std::nullopt;
    normal.normalize();
    if (normal.dot(ray) > 0.0) normal = -normal;
    return OrientedPoint{ray * scale.metres(s), normal, s0};
}

}  // namespace kinectlab
