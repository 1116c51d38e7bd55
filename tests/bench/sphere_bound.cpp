#include "tests/bench/sphere_bound.hpp"

#include <cmath>
#include <optional>

#include <Eigen/LU>

namespace kinectlab::bench {
namespace {

/// Disparity in steps where the ray enters the sphere.
std::optional<double> disparity(
    const RgbdCamera& camera,
    const Eigen::Vector3d& direction,
    const Eigen::Vector3d& centre_cam,
    double radius_m
) {
    // Foot of the perpendicular from the centre on the ray, then back by half a chord.
    const Eigen::Vector3d unit = direction.normalized();
    const double along = unit.dot(centre_cam);
    const double miss2 = (centre_cam - along * unit).squaredNorm();
    if (miss2 >= radius_m * radius_m) return std::nullopt;
    const double z = (along - std::sqrt(radius_m * radius_m - miss2)) * unit.z();
    return 1.0 / (z * camera.noise.inverse_depth_step);
}

}  // namespace

Eigen::Matrix3d centre_bound(
    const RgbdCamera& camera, const Eigen::Vector3d& centre_cam, double radius_m, double rim_m
) {
    constexpr double kDelta_m = 1e-6;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    const Eigen::Vector2d middle = camera.depth.project(centre_cam);
    const double reach = 1.2 * camera.depth.fx * radius_m / (centre_cam.z() - radius_m);
    for (int v = 0; v < camera.depth.height; ++v) {
        for (int u = 0; u < camera.depth.width; ++u) {
            if ((Eigen::Vector2d(u, v) - middle).norm() > reach) continue;
            const Eigen::Vector3d ray = camera.depth.ray(u, v);
            Eigen::Vector3d slope;
            bool seen = disparity(camera, ray, centre_cam, radius_m - rim_m).has_value();
            for (int axis = 0; axis < 3 && seen; ++axis) {
                const Eigen::Vector3d shift = kDelta_m * Eigen::Vector3d::Unit(axis);
                const auto plus = disparity(camera, ray, centre_cam + shift, radius_m);
                const auto minus = disparity(camera, ray, centre_cam - shift, radius_m);
                seen = plus && minus;
                if (seen) slope[axis] = (*plus - *minus) / (2.0 * kDelta_m);
            }
            if (seen) information += slope * slope.transpose();
        }
    }
    const double sigma = camera.noise.sigma_steps;
    return sigma * sigma * information.inverse();
}

Eigen::Matrix3d regular_centre_bound(
    const RgbdCamera& camera, const Eigen::Vector3d& centre_cam, double radius_m
) {
    double rim_m = 0.5 * centre_cam.z() / camera.depth.fx;
    Eigen::Matrix3d bound;
    for (int i = 0; i < 3; ++i) {  // the rim and the bound settle at once
        bound = centre_bound(camera, centre_cam, radius_m, rim_m);
        rim_m = 3.0 * std::sqrt((bound(0, 0) + bound(1, 1)) / 2.0);
    }
    return bound;
}

}  // namespace kinectlab::bench
