#include "pipeline/track/shape_linearise.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/vector8.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

struct Three {
    Float8 a, b, c;
};

KINECTLAB_INLINE Three linear(const std::array<float, 9>& rows, const Float8& x, const Float8& y) {
    return {
        rows[0] * x + rows[1] * y + rows[2],
        rows[3] * x + rows[4] * y + rows[5],
        rows[6] * x + rows[7] * y + rows[8]};
}

KINECTLAB_INLINE Float8 sqrt8(const Float8& value) {
    Float8 root;
    for (int lane = 0; lane < 8; ++lane)
        root[lane] = std::sqrt(value[lane]);
    return root;
}

/// Where the rays meet the shape: p = d z, 1/Z = w = far/near. The root's square is
/// ρ A - (X3² + κ (X1² + X2²)) with X = o x d by Lagrange's identity, which loses no digits in
/// single precision.
struct Hit {
    Three d;
    Float8 root2, root;
    Float8 far, near;
};

KINECTLAB_INLINE Hit meet8(const RoundOptics& at, const Float8& x, const Float8& y) {
    Hit hit;
    hit.d = linear(at.direction, x, y);
    const Three& d = hit.d;
    const Three m = linear(at.moment, x, y);
    const Float8 a = d.a * d.a + d.b * d.b + at.kappa * d.c * d.c;
    const Float8 b = -(at.o1 * d.a + at.o2 * d.b + at.kappa * at.o3 * d.c);
    hit.root2 = at.rho * a - (m.c * m.c + at.kappa * (m.a * m.a + m.b * m.b));
    hit.root = sqrt8(choose8(hit.root2 > 1e-12F, hit.root2, all8(1e-12F)));
    const Mask8 front = b > 0.0F;
    hit.far = choose8(front, b + hit.root, a);
    hit.near = choose8(front, all8(at.c), b - hit.root);
    return hit;
}

KINECTLAB_HOT_LOOP void choose(
    const RoundPixels& all, const RoundOptics& optics, float low, float high
) {
    const RoundPixels pixels = all;  // copies, which no store can change
    const RoundOptics at = optics;
    for (std::size_t i = 0; i < pixels.size; i += kFitLanes) {
        const Hit hit = meet8(at, load8(pixels.x + i), load8(pixels.y + i));
        const Float8 z = hit.near / hit.far;
        const Float8 height = at.o3 + z * hit.d.c;
        const Mask8 met = (hit.root2 > 0.0F) & (z > 0.0F) & (height >= at.least_height) &
                          (height >= low) & (height <= high) & (load8(pixels.s + i) > 0.0F);
        store8(pixels.used + i, keep8(all8(1.0F), met));
    }
}

constexpr std::size_t kChunk = 512;  // single precision sums this many at most

/// Of one chunk's pixels, by t1, t2, t3, ω1, ω2 and the size; small enough for the nearest cache.
struct Slopes {
    alignas(32) std::array<std::array<float, kChunk>, 6> by;
};

/// ∂w/∂t = w² (q1, q2, κ q3)/root, ∂w/∂ω = w² (κ - 1) q3 (q2, -q1)/root and ∂w/∂size likewise from
/// -∂F/∂size: all from F = 0 by implicit differentiation, where ∂(F w²)/∂w = 2 root.
KINECTLAB_INLINE void linearise_chunk(
    const RoundPixels& pixels,
    const RoundOptics& at,
    float per_gate2,
    std::size_t begin,
    std::size_t end,
    Slopes& slopes
) {
    const Float8 none = all8(__builtin_nanf(""));
    for (std::size_t i = begin; i < end; i += kFitLanes) {
        const Hit hit = meet8(at, load8(pixels.x + i), load8(pixels.y + i));
        // One division for w, z and 1/root: it takes as long as all the rest.
        const Float8 product = hit.far * hit.near;
        const Float8 inverse = 1.0F / (product * hit.root);
        const Float8 per_root = inverse * product, per_product = inverse * hit.root;
        const Float8 w = hit.far * hit.far * per_product;
        const Float8 z = hit.near * hit.near * per_product;
        const Float8 q1 = at.o1 + z * hit.d.a, q2 = at.o2 + z * hit.d.b, q3 = at.o3 + z * hit.d.c;
        const Mask8 met = (hit.root2 > 1e-12F) & (w > 0.0F) & (q3 >= at.least_height);
        const Float8 residual = load8(pixels.s + i) - w * at.per_step;
        const Float8 tukey = 1.0F - residual * residual * per_gate2;
        const Mask8 counts = met & (tukey > 0.0F);
        store8(pixels.residual + i, choose8(met, residual, none));
        store8(pixels.weight + i, keep8(load8(pixels.used + i) * tukey * tukey, counts));
        store8(pixels.height + i, choose8(met, q3, none));
        const Float8 scale = keep8(at.per_step * w * w * per_root, met);
        const Float8 bent = (at.kappa - 1.0F) * q3 * scale;
        const Float8 by_size = scale * (at.by_size + at.by_size3 * q3 * q3);
        const std::size_t k = i - begin;
        store8(slopes.by[0].data() + k, keep8(scale * q1, met));
        store8(slopes.by[1].data() + k, keep8(scale * q2, met));
        store8(slopes.by[2].data() + k, keep8(scale * at.kappa * q3, met));
        store8(slopes.by[3].data() + k, keep8(bent * q2, met));
        store8(slopes.by[4].data() + k, keep8(-bent * q1, met));
        store8(slopes.by[5].data() + k, keep8(by_size, met));
    }
}

KINECTLAB_INLINE double total(const Float8& value) {
    double sum = 0.0;
    for (int lane = 0; lane < 8; ++lane)
        sum += value[lane];
    return sum;
}

/// Over the first N of the slopes.
template <std::size_t N>
KINECTLAB_INLINE void sum_chunk(
    const std::array<const float*, 6>& slope,
    const float* weight,
    const float* residual,
    std::size_t size,
    NormalSums& sums
) {
    std::array<Float8, N*(N + 1) / 2> products{};
    std::array<Float8, N> gradient{};
    Float8 weights{};
    for (std::size_t i = 0; i < size; i += kFitLanes) {
        const Float8 w = load8(weight + i);
        const Mask8 counts = w > 0.0F;
        const Float8 r = keep8(load8(residual + i), counts);
        std::array<Float8, N> s;
        for (std::size_t k = 0; k < N; ++k)
            s[k] = load8(slope[k] + i);
        weights += w;
        std::size_t k = 0;
        for (std::size_t row = 0; row < N; ++row) {
            const Float8 weighted = w * s[row];
            gradient[row] += weighted * r;
            for (std::size_t column = 0; column <= row; ++column, ++k)
                products[k] += weighted * s[column];
        }
    }
    for (std::size_t k = 0; k < products.size(); ++k)
        sums.products[k] += total(products[k]);
    for (std::size_t k = 0; k < N; ++k)
        sums.gradient[k] += total(gradient[k]);
    sums.weights += total(weights);
}

KINECTLAB_HOT_LOOP void linearise(
    const RoundPixels& all,
    const RoundOptics& optics,
    float per_gate2,
    const RoundUnknowns& active,
    NormalSums& sums
) {
    const RoundPixels pixels = all;  // copies, which no store can change
    const RoundOptics at = optics;
    Slopes slopes;
    std::array<const float*, 6> slope{};
    std::size_t unknowns = 0;
    for (std::size_t k = 0; k < 6; ++k)
        if (active[k]) slope[unknowns++] = slopes.by[k].data();
    for (std::size_t begin = 0; begin < pixels.size; begin += kChunk) {
        const std::size_t end = begin + kChunk < pixels.size ? begin + kChunk : pixels.size;
        linearise_chunk(pixels, at, per_gate2, begin, end, slopes);
        const float *weight = pixels.weight + begin, *residual = pixels.residual + begin;
        const std::size_t size = end - begin;
        if (unknowns == 6) sum_chunk<6>(slope, weight, residual, size, sums);
        if (unknowns == 5) sum_chunk<5>(slope, weight, residual, size, sums);
        if (unknowns == 4) sum_chunk<4>(slope, weight, residual, size, sums);
        if (unknowns == 3) sum_chunk<3>(slope, weight, residual, size, sums);
    }
}

KINECTLAB_HOT_LOOP void linearise_flat(
    const PlanePixels& pixels, float mx, float my, float mz, float per_gate2, PlaneSums& sums
) {
    for (std::size_t begin = 0; begin < pixels.size; begin += kChunk) {
        const std::size_t end = begin + kChunk < pixels.size ? begin + kChunk : pixels.size;
        Float8 xx{}, xy{}, yy{}, sx{}, sy{}, n{}, rx{}, ry{}, sr{};
        for (std::size_t i = begin; i < end; i += kFitLanes) {
            const Float8 x = load8(pixels.x + i), y = load8(pixels.y + i);
            const Float8 s = load8(pixels.s + i);
            const Float8 r = s - (mx * x + my * y + mz);
            const Float8 tukey = 1.0F - r * r * per_gate2;
            const Float8 w = keep8(tukey * tukey, (tukey > 0.0F) & (s > 0.0F));
            store8(pixels.residual + i, r);
            store8(pixels.weight + i, w);
            const Float8 wx = w * x, wy = w * y;
            n += w, sx += wx, sy += wy, xx += wx * x, xy += wx * y, yy += wy * y;
            rx += wx * r, ry += wy * r, sr += w * r;
        }
        sums.xx += total(xx), sums.xy += total(xy), sums.yy += total(yy);
        sums.x += total(sx), sums.y += total(sy), sums.weights += total(n);
        sums.rx += total(rx), sums.ry += total(ry), sums.r += total(sr);
    }
}

std::array<float, 9> row_major(const Eigen::Matrix3d& matrix) {
    std::array<float, 9> values{};
    for (int i = 0; i < 9; ++i)
        values[static_cast<std::size_t>(i)] = static_cast<float>(matrix(i / 3, i % 3));
    return values;
}

}  // namespace

RoundOptics round_optics(
    const Shape& shape, const Shape& kind_of, const Eigen::Matrix3d& R_cam_shape, double per_step
) {
    const Quadric quadric = quadric_of(shape);
    const Eigen::Matrix3d R_shape_cam = R_cam_shape.transpose();
    const Eigen::Vector3d o = -(R_shape_cam * shape.point);
    Eigen::Matrix3d cross;  // (-point) x d
    const Eigen::Vector3d& c = shape.point;
    cross << 0.0, c.z(), -c.y(), -c.z(), 0.0, c.x(), c.y(), -c.x(), 0.0;
    RoundOptics at{};
    at.o1 = static_cast<float>(o.x()), at.o2 = static_cast<float>(o.y());
    at.o3 = static_cast<float>(o.z());
    at.direction = row_major(R_shape_cam);
    at.moment = row_major(R_shape_cam * cross);
    at.kappa = static_cast<float>(quadric.kappa);
    at.rho = static_cast<float>(quadric.rho);
    at.c = static_cast<float>(
        o.x() * o.x() + o.y() * o.y() + quadric.kappa * o.z() * o.z() - quadric.rho
    );
    at.least_height = -1e9F;
    if (kind_of.kind == ShapeKind::cone) {
        const double tangent = std::tan(shape.size);
        at.by_size3 = static_cast<float>(tangent * (1.0 + tangent * tangent));
        at.least_height = 0.0F;
    } else {
        at.by_size = static_cast<float>(shape.size);
    }
    at.per_step = static_cast<float>(per_step);
    return at;
}

void choose_pixels(const RoundPixels& pixels, const RoundOptics& optics, double low, double high) {
    choose(pixels, optics, static_cast<float>(low), static_cast<float>(high));
}

NormalSums linearise_round(
    const RoundPixels& pixels,
    const RoundOptics& optics,
    double gate_steps,
    const RoundUnknowns& active
) {
    NormalSums sums;
    linearise(pixels, optics, static_cast<float>(1.0 / (gate_steps * gate_steps)), active, sums);
    return sums;
}

PlaneSums linearise_plane(
    const PlanePixels& pixels, const std::array<float, 3>& m, float gate_steps
) {
    PlaneSums sums;
    linearise_flat(pixels, m[0], m[1], m[2], 1.0F / (gate_steps * gate_steps), sums);
    return sums;
}

}  // namespace kinectlab
