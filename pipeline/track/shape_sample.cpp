#include "pipeline/track/shape_sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace kinectlab {
namespace {

using Sample = std::span<const OrientedPoint>;

constexpr double kMinSine = 0.15;         // between normals, else their lines are parallel
constexpr double kMinHeightShare = 0.2;   // of a triangle to its base, else it is a line
constexpr double kMinDeterminant = 4e-3;  // of three normals, else their planes meet nowhere sure
constexpr double kMinConeAngle = 0.05, kMaxConeAngle = 1.35;  // rad: cylinders and planes are
                                                              // looked for as such

std::optional<Shape> plane(Sample s) {
    const Eigen::Vector3d a = s[1].p_cam - s[0].p_cam, b = s[2].p_cam - s[0].p_cam;
    Eigen::Vector3d normal = a.cross(b);
    const double longest2 =
        std::max({a.squaredNorm(), b.squaredNorm(), (s[2].p_cam - s[1].p_cam).squaredNorm()});
    const double area = normal.norm();
    if (!(area > kMinHeightShare * longest2)) return std::nullopt;
    normal /= area;
    if (normal.dot(s[0].p_cam) > 0.0) normal = -normal;
    return Shape{ShapeKind::plane, (s[0].p_cam + s[1].p_cam + s[2].p_cam) / 3.0, normal, 0.0};
}

std::optional<Shape> sphere(Sample s) {
    // Closest points of the lines p0 + t0·n0 and p1 + t1·n1.
    const double cosine = s[0].normal.dot(s[1].normal);
    const double sine2 = 1.0 - cosine * cosine;
    if (!(sine2 > kMinSine * kMinSine)) return std::nullopt;
    const Eigen::Vector3d apart = s[1].p_cam - s[0].p_cam;
    const double along_0 = apart.dot(s[0].normal), along_1 = apart.dot(s[1].normal);
    const double t0 = (along_0 - cosine * along_1) / sine2;
    const double t1 = (cosine * along_0 - along_1) / sine2;
    if (!(t0 < 0.0 && t1 < 0.0)) return std::nullopt;  // the centre is behind the surface
    Shape found{ShapeKind::sphere};
    found.point = 0.5 * (s[0].p_cam + t0 * s[0].normal + s[1].p_cam + t1 * s[1].normal);
    found.size = 0.5 * ((s[0].p_cam - found.point).norm() + (s[1].p_cam - found.point).norm());
    return found;
}

std::optional<Shape> cylinder(Sample s) {
    Eigen::Vector3d axis = s[0].normal.cross(s[1].normal);
    const double sine = axis.norm();
    if (!(sine > kMinSine)) return std::nullopt;
    axis /= sine;
    // Across the axis the second point moves into the first one's plane, and the normals' lines
    // meet there.
    OrientedPoint moved = s[1];
    moved.p_cam -= axis * axis.dot(s[1].p_cam - s[0].p_cam);
    const OrientedPoint pair[2] = {s[0], moved};
    auto circle = sphere(pair);
    if (!circle) return std::nullopt;
    circle->kind = ShapeKind::cylinder;
    circle->axis = axis;
    return circle;
}

std::optional<Shape> cone(Sample s) {
    Eigen::Matrix3d normals;
    Eigen::Vector3d offsets;
    for (int i = 0; i < 3; ++i) {
        const auto& point = s[static_cast<std::size_t>(i)];
        normals.row(i) = point.normal.transpose();
        offsets[i] = point.normal.dot(point.p_cam);
    }
    if (!(std::abs(normals.determinant()) > kMinDeterminant)) return std::nullopt;
    Shape found{ShapeKind::cone};
    found.point = normals.inverse() * offsets;
    std::array<Eigen::Vector3d, 3> tips;
    for (std::size_t i = 0; i < 3; ++i) {
        tips[i] = s[i].p_cam - found.point;
        const double length = tips[i].norm();
        if (!(length > 1e-6)) return std::nullopt;
        tips[i] /= length;
    }
    found.axis = (tips[1] - tips[0]).cross(tips[2] - tips[0]);
    const double area = found.axis.norm();
    if (!(area > 1e-4)) return std::nullopt;
    found.axis /= area;
    if (found.axis.dot(tips[0]) < 0.0) found.axis = -found.axis;
    for (std::size_t i = 0; i < 3; ++i) {
        found.size += std::acos(std::clamp(found.axis.dot(tips[i]), -1.0, 1.0)) / 3.0;
        if (outwards(found, s[i].p_cam).dot(s[i].normal) <= 0.0) return std::nullopt;
    }
    if (found.size < kMinConeAngle || found.size > kMaxConeAngle) return std::nullopt;
    return found;
}

}  // namespace

std::optional<Shape> through_sample(ShapeKind kind, Sample sample) {
    if (sample.size() < sample_size(kind)) return std::nullopt;
    std::optional<Shape> found;
    switch (kind) {
        case ShapeKind::plane:
            found = plane(sample);
            break;
        case ShapeKind::sphere:
            found = sphere(sample);
            break;
        case ShapeKind::cylinder:
            found = cylinder(sample);
            break;
        case ShapeKind::cone:
            found = cone(sample);
            break;
    }
    if (found && !(found->point.allFinite() && found->axis.allFinite())) return std::nullopt;
    return found;
}

}  // namespace kinectlab
