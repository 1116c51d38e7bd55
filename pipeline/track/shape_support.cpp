#include "pipeline/track/shape_support.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/vector8.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

/// A shape in single precision.
struct Flat {
    float cx, cy, cz, ax, ay, az;
    float bend, rho;     ///< κ - 1 and ρ
    float least_height;  ///< along the axis: a cone has but one half
    float sigmas, least2, extra, cos_normal;
    bool is_plane;
};

Flat flat(const Shape& shape, const Tolerance& tolerance) {
    const Quadric quadric = quadric_of(shape);
    const bool round = shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::cylinder;
    Flat f{};
    const Eigen::Vector3f c = shape.point.cast<float>(), a = shape.axis.cast<float>();
    f.cx = c.x(), f.cy = c.y(), f.cz = c.z();
    f.ax = a.x(), f.ay = a.y(), f.az = a.z();
    f.bend = static_cast<float>(quadric.kappa - 1.0);
    f.rho = static_cast<float>(quadric.rho);
    f.least_height = shape.kind == ShapeKind::cone ? 0.0F : -1e9F;
    f.sigmas = static_cast<float>(tolerance.sigmas);
    f.least2 = static_cast<float>(tolerance.least_m * tolerance.least_m);
    f.extra = static_cast<float>(round ? tolerance.of_size * shape.size : 0.0);
    f.cos_normal = static_cast<float>(tolerance.cos_normal);
    f.is_plane = shape.kind == ShapeKind::plane;
    return f;
}

/// The distance from a quadric is F/|∇F| to first order. With g = ∇F/2 the two conditions are
/// |F| <= 2 ε |g| and n·g >= cos α |g|; squared, they need no root. NaN fails both.
KINECTLAB_INLINE Mask8 holds8(const Flat& f, const SurfacePoints& points, std::size_t i) {
    const Float8 qx = load8(points.px.data() + i) - f.cx;
    const Float8 qy = load8(points.py.data() + i) - f.cy;
    const Float8 qz = load8(points.pz.data() + i) - f.cz;
    const Float8 nx = load8(points.nx.data() + i), ny = load8(points.ny.data() + i),
                 nz = load8(points.nz.data() + i);
    const Float8 height = f.ax * qx + f.ay * qy + f.az * qz;
    const Float8 noise = f.sigmas * load8(points.sigma.data() + i);
    const Float8 facing = f.ax * nx + f.ay * ny + f.az * nz;
    if (f.is_plane) return (height * height <= noise * noise + f.least2) & (facing >= f.cos_normal);
    const Float8 gx = qx + f.bend * height * f.ax;
    const Float8 gy = qy + f.bend * height * f.ay;
    const Float8 gz = qz + f.bend * height * f.az;
    const Float8 off = qx * gx + qy * gy + qz * gz - f.rho;  // F = q·g - ρ
    const Float8 g2 = gx * gx + gy * gy + gz * gz;
    const Float8 epsilon2 = noise * noise + f.least2 + f.extra * f.extra;
    const Float8 along = nx * gx + ny * gy + nz * gz;
    return (off * off <= 4.0F * epsilon2 * g2) & (along > 0.0F) &
           (along * along >= f.cos_normal * f.cos_normal * g2) & (height >= f.least_height);
}

KINECTLAB_HOT_LOOP int count(
    const Flat& f, const SurfacePoints& points, std::size_t begin, std::size_t end
) {
    Mask8 sum{};
    for (std::size_t i = begin; i < end; i += SurfacePoints::kLanes)
        sum -= holds8(f, points, i);
    int total = 0;
    for (int lane = 0; lane < 8; ++lane)
        total += sum[lane];
    return total;
}

KINECTLAB_HOT_LOOP void mark(const Flat& f, const SurfacePoints& points, std::uint8_t* holds) {
    for (std::size_t i = 0; i < points.px.size(); i += SurfacePoints::kLanes) {
        const Mask8 in = holds8(f, points, i);
        for (std::size_t lane = 0; lane < 8; ++lane)
            holds[i + lane] = in[lane] != 0 ? 1 : 0;
    }
}

}  // namespace

int count_support(
    const Shape& shape,
    const SurfacePoints& points,
    std::size_t begin,
    std::size_t end,
    const Tolerance& tolerance
) {
    return count(flat(shape, tolerance), points, begin, std::min(end, points.px.size()));
}

void mark_support(
    const Shape& shape,
    const SurfacePoints& points,
    const Tolerance& tolerance,
    std::span<std::uint8_t> holds
) {
    mark(flat(shape, tolerance), points, holds.data());
}

SupportBounds extrapolate(int found, std::size_t seen, std::size_t size) {
    // The paper's f(N, x, n) with N = -2 - |S1|, x = -2 - |S|, n = -1 - found.
    const auto subset = static_cast<double>(std::min(seen, size));
    const double population = -2.0 - subset, draws = -2.0 - static_cast<double>(size);
    const double successes = -1.0 - found;
    const double mean = draws * successes / population;
    const double spread =
        std::sqrt(std::max(
            0.0,
            draws * successes * (population - draws) * (population - successes) / (population - 1.0)
        )) /
        std::abs(population);
    const auto all = static_cast<double>(size);
    const double middle = std::clamp(-1.0 - mean, 0.0, all);
    if (seen >= size) return {double(found), double(found), double(found)};
    return {std::clamp(middle - spread, 0.0, all), middle, std::clamp(middle + spread, 0.0, all)};
}

}  // namespace kinectlab
