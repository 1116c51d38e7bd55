#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kinectlab {

/// In the order of simplicity: each is a limiting case of a later one.
enum class ShapeKind : std::uint8_t { plane, sphere, cylinder, cone };

inline constexpr std::array<std::string_view, 4> kShapeNames{"plane", "sphere", "cylinder", "cone"};

[[nodiscard]] inline std::string_view name_of(ShapeKind kind) {
    return kShapeNames[static_cast<std::size_t>(kind)];
}

/// A surface in the camera frame, metres; endless, as its equation is. Spheres, cylinders and cones
/// are seen from outside.
struct Shape {
    ShapeKind kind = ShapeKind::plane;
    /// A point of the plane; the sphere's centre; a point of the cylinder's axis; the cone's apex.
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    /// Unit: the plane's normal towards the camera; the cylinder's axis; the cone's, from the apex
    /// into it. Means nothing for a sphere.
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    /// Radius of a sphere or cylinder, m; angle between a cone's axis and its surface, rad.
    double size = 0.0;
};

/// Camera from object for a shape that shows its axis only: z along it, x as near to `wanted_x` as
/// can be. All unit vectors.
[[nodiscard]] inline Eigen::Quaterniond attitude_about(
    const Eigen::Vector3d& z, const Eigen::Vector3d& wanted_x
) {
    const bool along = std::abs(wanted_x.dot(z)) > 0.95;
    const Eigen::Vector3d x = along ? Eigen::Vector3d(z.unitOrthogonal()) : wanted_x;
    Eigen::Matrix3d R_cam_obj;
    R_cam_obj.col(0) = (x - z * z.dot(x)).normalized();
    R_cam_obj.col(1) = z.cross(R_cam_obj.col(0));
    R_cam_obj.col(2) = z;
    return Eigen::Quaterniond(R_cam_obj);
}

/// Sphere, cylinder and cone are one family. About their own point and axis, with q1, q2 across the
/// axis and q3 along it,
///
///     F(q) = q1² + q2² + κ q3² - ρ = 0:   sphere κ = 1, ρ = r²;   cylinder κ = 0, ρ = r²;
///                                         cone κ = -tan² θ, ρ = 0, q3 > 0.
struct Quadric {
    double kappa = 0.0;
    double rho = 0.0;
};

[[nodiscard]] inline Quadric quadric_of(const Shape& shape) {
    const double r2 = shape.size * shape.size;
    switch (shape.kind) {
        case ShapeKind::sphere:
            return {1.0, r2};
        case ShapeKind::cylinder:
            return {0.0, r2};
        case ShapeKind::cone:
            return {-std::pow(std::tan(shape.size), 2), 0.0};
        case ShapeKind::plane:
            break;
    }
    return {};
}

/// Along the axis from the shape's point, m.
[[nodiscard]] inline double height_on(const Shape& shape, const Eigen::Vector3d& p_cam) {
    return shape.axis.dot(p_cam - shape.point);
}

/// Half the gradient of the shape's F, not of unit length: outwards.
[[nodiscard]] inline Eigen::Vector3d outwards(const Shape& shape, const Eigen::Vector3d& p_cam) {
    if (shape.kind == ShapeKind::plane) return shape.axis;
    const double kappa = quadric_of(shape).kappa;
    return p_cam - shape.point + (kappa - 1.0) * height_on(shape, p_cam) * shape.axis;
}

/// Where the ray d = (x, y, 1) from the camera first meets the shape from outside, as inverse depth
/// 1/Z in 1/m; NaN if it does not.
[[nodiscard]] inline double meet(const Eigen::Vector3d& ray, const Shape& shape) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (shape.kind == ShapeKind::plane) {
        const double w = shape.axis.dot(ray) / shape.axis.dot(shape.point);
        return w > 0.0 ? w : kNone;
    }
    // With p = d/w, F(p) w² = A - 2 B w + C w²; of the two roots the one where F falls.
    const Quadric q = quadric_of(shape);
    const auto product = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return a.dot(b) + (q.kappa - 1.0) * shape.axis.dot(a) * shape.axis.dot(b);
    };
    const double a = product(ray, ray), b = product(ray, shape.point);
    const double c = product(shape.point, shape.point) - q.rho;
    const double root2 = b * b - a * c;
    if (!(root2 > 0.0)) return kNone;
    const double root = std::sqrt(root2);
    const double w = b > 0.0 ? (b + root) / c : a / (b - root);
    if (!(w > 0.0) || !std::isfinite(w)) return kNone;
    if (shape.kind == ShapeKind::cone && height_on(shape, ray / w) <= 0.0) return kNone;
    return w;
}

}  // namespace kinectlab
