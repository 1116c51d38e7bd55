#include "pipeline/track/sphere_linearise.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/vector8.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

constexpr float kLeastCosine2 = 4e-4F;  // keeps the slopes of grazing rays finite
constexpr std::size_t kChunk = 512;     // single precision sums this many at most

KINECTLAB_HOT_LOOP void choose(const SpherePixels& pixels, const SphereOptics& optics) {
    const SphereOptics at = optics;
    const float *xs = pixels.x, *ys = pixels.y, *ss = pixels.s;
    float* used = pixels.used;
#pragma GCC ivdep  // the arrays are all different ones
    for (std::size_t i = 0; i < pixels.size; ++i) {
        const float x = xs[i], y = ys[i];
        const float d2 = x * x + y * y + 1.0F;
        const float read = std::min(ss[i], 1.0F);  // nothing is as far as one step, 350 m
        used[i] = root2_of(x, y, d2, at.chosen, at) > 0.0F ? read : 0.0F;
    }
}

/// From the implicit equation of meet(): dw/dc = (w d - w² c)/root and dw/dr = w² r/root.
KINECTLAB_HOT_LOOP void linearise(const SpherePixels& pixels, const SphereOptics& optics) {
    const SphereOptics at = optics;
    const float* xs = pixels.x;
    const float* ys = pixels.y;
    const float* ss = pixels.s;
    float* weights = pixels.weight;
    float* residuals = pixels.residual;
    float* by_x = pixels.slope[0];
    float* by_y = pixels.slope[1];
    float* by_z = pixels.slope[2];
    float* by_r = pixels.slope[3];
    const float* used = pixels.used;
    float* steep = pixels.steep;
    const float r2 = at.radius * at.radius;
    const float per_power = 1.0F / at.power, per_gate2 = 1.0F / (at.gate * at.gate);
#pragma GCC ivdep  // the arrays are all different ones
    for (std::size_t i = 0; i < pixels.size; ++i) {
        const float x = xs[i], y = ys[i];
        const float d2 = x * x + y * y + 1.0F;
        const float root2 = root2_of(x, y, d2, at.radius, at);
        const float root = std::sqrt(std::max(root2, kLeastCosine2 * r2 * d2));
        const float w = (x * at.cx + y * at.cy + at.cz + root) * per_power;
        const float aside_x = x - w * at.cx, aside_y = y - w * at.cy;
        const float steepness = at.per_step / root;
        // A pixel that looks aside by σ_lateral errs the more, the steeper the surface.
        const float slope2 = steepness * steepness * (aside_x * aside_x + aside_y * aside_y);
        const float precision = 1.0F / (1.0F + at.lateral * slope2);
        const float residual = ss[i] - w * at.per_step;
        const float tukey = std::max(0.0F, 1.0F - residual * residual * precision * per_gate2);
        weights[i] = used[i] * tukey * tukey * precision;
        residuals[i] = residual;
        steep[i] = slope2;
        const float scale = w * steepness;
        by_x[i] = scale * aside_x;
        by_y[i] = scale * aside_y;
        by_z[i] = scale * (1.0F - w * at.cz);
        by_r[i] = scale * w * at.radius;
    }
}

KINECTLAB_INLINE double total(const Float8& value) {
    double sum = 0.0;
    for (int lane = 0; lane < 8; ++lane)
        sum += value[lane];
    return sum;
}

KINECTLAB_HOT_LOOP void sum_all(const SpherePixels& pixels, SphereSums& sums) {
    for (std::size_t begin = 0; begin < pixels.size; begin += kChunk) {
        const std::size_t end = std::min(begin + kChunk, pixels.size);
        std::array<Float8, 10> products{};
        std::array<Float8, 4> gradient{};
        Float8 weights{}, steep{}, squares{};
        for (std::size_t i = begin; i < end; i += kSphereLanes) {
            const Float8 w = load8(pixels.weight + i), r = load8(pixels.residual + i);
            std::array<Float8, 4> s;
            for (std::size_t k = 0; k < 4; ++k)
                s[k] = load8(pixels.slope[k] + i);
            weights += w;
            steep += w * load8(pixels.steep + i);
            squares += w * r * r;
            std::size_t k = 0;
            for (std::size_t row = 0; row < 4; ++row) {
                const Float8 weighted = w * s[row];
                gradient[row] += weighted * r;
                for (std::size_t column = 0; column <= row; ++column, ++k)
                    products[k] += weighted * s[column];
            }
        }
        for (std::size_t k = 0; k < 10; ++k)
            sums.products[k] += total(products[k]);
        for (std::size_t k = 0; k < 4; ++k)
            sums.gradient[k] += total(gradient[k]);
        sums.weights += total(weights);
        sums.steep += total(steep);
        sums.squares += total(squares);
    }
}

}  // namespace

SphereOptics sphere_optics(const Sphere& sphere, double rim_m) {
    const Eigen::Vector3f c = sphere.centre_cam.cast<float>();
    const double power = sphere.centre_cam.squaredNorm() - sphere.radius * sphere.radius;
    const double chosen = std::max(0.5 * sphere.radius, sphere.radius - rim_m);
    SphereOptics at{};
    at.cx = c.x(), at.cy = c.y(), at.cz = c.z();
    at.radius = static_cast<float>(sphere.radius);
    at.power = static_cast<float>(power);
    at.chosen = static_cast<float>(chosen);
    return at;
}

void choose_pixels(const SpherePixels& pixels, const SphereOptics& optics) {
    choose(pixels, optics);
}

void linearise_sphere(const SpherePixels& pixels, const SphereOptics& optics) {
    linearise(pixels, optics);
}

SphereSums sum_equations(const SpherePixels& pixels) {
    SphereSums sums;
    sum_all(pixels, sums);
    return sums;
}

}  // namespace kinectlab
