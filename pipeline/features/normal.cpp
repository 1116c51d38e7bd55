#include "pipeline/features/normal.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

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

    // Least squares of s = s0 + a·du + b·dv + c over the window.
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d y = Eigen::Vector3d::Zero();
    int used = 0;
    for (int dv = -half_window; dv <= half_window; ++dv) {
        for (int du = -half_window; du <= half_window; ++du) {
            const int column = u + du, row = v + dv;
            if (column < 0 || row < 0 || column >= camera.width || row >= camera.height) continue;
            const auto reading = depth[static_cast<std::size_t>(row * camera.width + column)];
            if (reading == 0) continue;
            const double s = scale.steps(reading) - s0;
            if (std::abs(s) > max_jump_steps) continue;
            const Eigen::Vector3d x(du, dv, 1.0);
            A.selfadjointView<Eigen::Lower>().rankUpdate(x);
            y += s * x;
            ++used;
        }
    }
    const int side = 2 * half_window + 1;
    if (2 * used < side * side) return std::nullopt;
    const Eigen::Vector3d slope = A.selfadjointView<Eigen::Lower>().ldlt().solve(y);

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
