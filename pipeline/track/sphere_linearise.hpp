#pragma once

#include <array>
#include <cstddef>

#include "pipeline/track/sphere_model.hpp"

namespace kinectlab {

/// The inner loops of SphereFitter. Arrays are padded to a multiple of kSphereLanes with s = 0.
inline constexpr std::size_t kSphereLanes = 8;

struct SpherePixels {
    std::size_t size;
    const float *x, *y, *s;                   ///< ray and disparity; 0 = no reading
    float *used, *weight, *residual, *steep;  ///< steep: the surface's slope², (steps/px)²·f²
    std::array<float*, 4> slope;              ///< of the disparity by centre and radius
};

/// A sphere as the rays see it, in single precision.
struct SphereOptics {
    float cx, cy, cz, radius;
    float power;     ///< c·c - r²
    float chosen;    ///< radius of what is surely sphere: the rim left out
    float per_step;  ///< steps for each 1/m
    float gate;      ///< steps: residuals beyond do not count
    float lateral;   ///< (σ_lateral / (σ f))², px² / steps²
};

[[nodiscard]] SphereOptics sphere_optics(const Sphere& sphere, double rim_m);

/// The square of meet()'s root from the cross product, r² d·d - |d x c|², which loses no digits in
/// single precision.
[[nodiscard]] inline float root2_of(
    float x, float y, float d2, float radius, const SphereOptics& at
) {
    const float across_x = y * at.cz - at.cy;
    const float across_y = at.cx - x * at.cz;
    const float across_z = x * at.cy - y * at.cx;
    const float across2 = across_x * across_x + across_y * across_y + across_z * across_z;
    return radius * radius * d2 - across2;
}

/// used = 1 for the pixels that the fit rests on: readings whose rays pass well within the outline.
void choose_pixels(const SpherePixels& pixels, const SphereOptics& optics);

/// Residual, Tukey's weight, steepness and slopes of every pixel.
void linearise_sphere(const SpherePixels& pixels, const SphereOptics& optics);

struct SphereSums {
    std::array<double, 10> products{};  ///< Σ weight·slope·slope, the lower triangle row by row
    std::array<double, 4> gradient{};   ///< Σ weight·slope·residual
    double weights = 0.0, steep = 0.0;  ///< Σ weight and Σ weight·steep
    double squares = 0.0;               ///< Σ weight·residual²
};
[[nodiscard]] SphereSums sum_equations(const SpherePixels& pixels);

}  // namespace kinectlab
