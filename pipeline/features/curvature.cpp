#include "pipeline/features/curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace kinectlab {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kMostAcross = 9;  // samples across the neighbourhood
constexpr double kTrim = 2.5;
constexpr double kSignificant = 2.0;  // standard uncertainties
constexpr double kFlat = 2.0;         // 1/m: no object of half a metre shows less

struct Neighbour {
    double du, dv, s;  // s: disparity from the middle's, steps
};

struct Neighbours {
    std::array<Neighbour, kMostAcross * kMostAcross> all;
    std::size_t count = 0;
    std::size_t looked_at = 0;
    double reach = 1.0;  // px, so that the equations are well scaled
};

Neighbours gather(
    std::span<const std::uint16_t> depth,
    const Pinhole& camera,
    const DisparityScale& scale,
    int column,
    int row,
    double radius_m
) {
    const std::uint16_t own = depth[static_cast<std::size_t>(row * camera.width + column)];
    const double z = own / scale.counts_per_m;
    const double middle = scale.steps(own);
    const double reach = std::clamp(radius_m * camera.fx / z, 2.0, 60.0);
    const int stride = std::max(1, static_cast<int>(std::ceil(2.0 * reach / (kMostAcross - 1))));
    const int half = std::min(static_cast<int>(reach) / stride, kMostAcross / 2);
    Neighbours found;
    found.reach = half * stride;
    for (int i = -half; i <= half; ++i) {
        for (int j = -half; j <= half; ++j) {
            if (i * i + j * j > half * half + half) continue;
            ++found.looked_at;
            const int u = column + j * stride, v = row + i * stride;
            if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
            const std::uint16_t counts = depth[static_cast<std::size_t>(v * camera.width + u)];
            if (counts == 0) continue;
            if (std::abs(counts / scale.counts_per_m - z) > radius_m) continue;
            found.all[found.count++] = {
                j * stride / found.reach, i * stride / found.reach, scale.steps(counts) - middle};
        }
    }
    return found;
}

struct Quadric {
    Vector6d c;  // 1, du, dv, du², du dv, dv²
    Matrix6d information;
    double rms = 0.0;
};

Vector6d basis(const Neighbour& n) {
    Vector6d b;
    b << 1.0, n.du, n.dv, n.du * n.du, n.du * n.dv, n.dv * n.dv;
    return b;
}

std::optional<Quadric> fit_quadric(const Neighbours& neighbours) {
    Quadric quadric;
    quadric.information.setZero();
    Vector6d right = Vector6d::Zero();
    for (std::size_t i = 0; i < neighbours.count; ++i) {
        const Vector6d b = basis(neighbours.all[i]);
        for (int r = 0; r < 6; ++r) {
            for (int c = 0; c <= r; ++c)
                quadric.information(r, c) += b[r] * b[c];
            right[r] += b[r] * neighbours.all[i].s;
        }
    }
    quadric.information = Matrix6d(quadric.information.selfadjointView<Eigen::Lower>());
    const Eigen::LLT<Matrix6d> solver(quadric.information);
    if (solver.info() != Eigen::Success) return std::nullopt;
    quadric.c = solver.solve(right);
    double squares = 0.0;
    for (std::size_t i = 0; i < neighbours.count; ++i) {
        const double r = quadric.c.dot(basis(neighbours.all[i])) - neighbours.all[i].s;
        squares += r * r;
    }
    quadric.rms = std::sqrt(squares / static_cast<double>(neighbours.count));
    if (!quadric.c.allFinite()) return std::nullopt;
    return quadric;
}

void trim(Neighbours& neighbours, const Quadric& quadric) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < neighbours.count; ++i) {
        const auto& n = neighbours.all[i];
        if (std::abs(quadric.c.dot(basis(n)) - n.s) <= kTrim * quadric.rms)
            neighbours.all[kept++] = n;
    }
    neighbours.count = kept;
}

/// First and second fundamental form of r(u, v) = ray(u, v) / s(u, v), and what follows from them.
std::optional<CurvedPoint> bend(
    const Eigen::Vector3d& ray, const Pinhole& camera, double s, const Vector6d& c
) {
    const double z = 1.0 / s;
    const double su = c[1], sv = c[2], suu = 2.0 * c[3], suv = c[4], svv = 2.0 * c[5];
    const double zu = -su * z * z, zv = -sv * z * z;
    const double zuu = -suu * z * z + 2.0 * su * su * z * z * z;
    const double zuv = -suv * z * z + 2.0 * su * sv * z * z * z;
    const double zvv = -svv * z * z + 2.0 * sv * sv * z * z * z;
    const Eigen::Vector3d du(1.0 / camera.fx, 0.0, 0.0), dv(0.0, 1.0 / camera.fy, 0.0);
    const Eigen::Vector3d ru = zu * ray + z * du, rv = zv * ray + z * dv;
    Eigen::Vector3d n = ru.cross(rv);
    if (!(n.norm() > 1e-15)) return std::nullopt;
    n.normalize();
    if (n.dot(ray) > 0.0) n = -n;
    const double l = n.dot(zuu * ray + 2.0 * zu * du);
    const double m = n.dot(zuv * ray + zu * dv + zv * du);
    const double q = n.dot(zvv * ray + 2.0 * zv * dv);

    // In an orthonormal basis of the tangent plane the second form's eigenvalues are k1 and k2.
    const Eigen::Vector3d e1 = ru.normalized(), e2 = n.cross(e1);
    Eigen::Matrix2d to_uv;  // columns: (du, dv) of a step along e1, e2
    to_uv << ru.dot(e1), rv.dot(e1), ru.dot(e2), rv.dot(e2);
    to_uv = Eigen::Matrix2d(to_uv.inverse());
    Eigen::Matrix2d second;
    second << l, m, m, q;
    const Eigen::Matrix2d shape = to_uv.transpose() * second * to_uv;
    const double mean = 0.5 * (shape(0, 0) + shape(1, 1));
    const double half_difference =
        std::hypot(0.5 * (shape(0, 0) - shape(1, 1)), 0.5 * (shape(0, 1) + shape(1, 0)));
    CurvedPoint point;
    point.p_cam = z * ray;
    point.normal = n;
    point.k1 = mean + half_difference;
    point.k2 = mean - half_difference;
    const double along_k1 = 0.5 * std::atan2(shape(0, 1) + shape(1, 0), shape(0, 0) - shape(1, 1));
    const double angle = std::abs(point.k1) < std::abs(point.k2) ? along_k1 : along_k1 + 0.5 * M_PI;
    point.direction = std::cos(angle) * e1 + std::sin(angle) * e2;
    if (!std::isfinite(point.k1 + point.k2) || !point.direction.allFinite()) return std::nullopt;
    return point;
}

}  // namespace

double CurvedPoint::curvedness() const {
    return std::sqrt(0.5 * (k1 * k1 + k2 * k2));
}

double CurvedPoint::shape_index() const {
    if (k1 == 0.0 && k2 == 0.0) return 0.5;
    return 0.5 - std::atan2(k1 + k2, k1 - k2) / M_PI;
}

SurfaceType surface_type(const CurvedPoint& point) {
    const double least = std::max(kFlat, kSignificant * point.sigma_k);
    const auto sign = [least](double k) {
        return k > least ? 1 : k < -least ? -1 : 0;
    };
    const int a = sign(point.k1), b = sign(point.k2);
    if (a == 0 && b == 0) return SurfaceType::flat;
    if (a * b < 0) return SurfaceType::saddle;
    if (a * b > 0) return a < 0 ? SurfaceType::peak : SurfaceType::pit;
    return a + b < 0 ? SurfaceType::ridge : SurfaceType::rut;
}

std::optional<CurvedPoint> curved_point(
    std::span<const std::uint16_t> depth,
    const Pinhole& camera,
    const DisparityScale& scale,
    int column,
    int row,
    double radius_m
) {
    const std::uint16_t own = depth[static_cast<std::size_t>(row * camera.width + column)];
    if (own == 0) return std::nullopt;
    Neighbours neighbours = gather(depth, camera, scale, column, row, radius_m);
    const auto enough = [&] {
        return neighbours.count >= 10 && 3 * neighbours.count >= neighbours.looked_at;
    };
    if (!enough()) return std::nullopt;
    auto quadric = fit_quadric(neighbours);
    if (!quadric) return std::nullopt;
    if (quadric->rms > 1.3 * scale.sigma_at(scale.steps(own))) {
        trim(neighbours, *quadric);
        if (!enough()) return std::nullopt;
        quadric = fit_quadric(neighbours);
        if (!quadric) return std::nullopt;
    }
    // Back from shares of the reach and steps to pixels and 1/m.
    const double step = scale.inverse_depth_step, r = neighbours.reach;
    Vector6d c = quadric->c * step;
    c.segment<2>(1) /= r;
    c.tail<3>() /= r * r;
    auto point = bend(camera.ray(column, row), camera, (step * scale.steps(own)) + c[0], c);
    if (!point) return std::nullopt;
    const double z = point->p_cam.z();
    const double slant = std::max(0.1, std::abs(point->normal.dot(point->p_cam.normalized())));
    const double sigma = std::max(quadric->rms, scale.sigma_at(scale.steps(own)));
    const double coefficient =
        std::sqrt(quadric->information.inverse().diagonal().tail<3>().maxCoeff());
    const double across = r * z / camera.fx;  // m
    point->sigma_k =
        2.0 * coefficient * sigma * step * z * z / (across * across) * slant * slant * slant;
    return point;
}

}  // namespace kinectlab
