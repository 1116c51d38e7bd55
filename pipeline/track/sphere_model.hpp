#pragma once

#include <cmath>

#include <Eigen/Core>

namespace kinectlab {

/// A sphere in the camera frame, metres.
struct Sphere {
    Eigen::Vector3d centre_cam = Eigen::Vector3d::Zero();
    double radius = 0.0;
};

/// Where a viewing ray d = (x, y, 1) meets a sphere first, as inverse depth w = 1/Z. With p = d/w
/// on the sphere, |d/w - c|² = r² is quadratic in w: d·d - 2 (d·c) w + (c·c - r²) w² = 0, and the
/// nearer of the two points has the larger w.
struct RayHit {
    bool hits = false;
    double w = 0.0;     ///< 1/m
    double root = 0.0;  ///< r |d| cos(incidence): near 0 the ray grazes
};

[[nodiscard]] inline RayHit meet(const Eigen::Vector3d& ray, const Sphere& sphere) {
    const double b = ray.dot(sphere.centre_cam);
    const double c = sphere.centre_cam.squaredNorm() - sphere.radius * sphere.radius;
    const double discriminant = b * b - ray.squaredNorm() * c;
    if (discriminant <= 0.0 || c <= 0.0 || b <= 0.0) return {};
    const double root = std::sqrt(discriminant);
    return {true, (b + root) / c, root};
}

}  // namespace kinectlab
