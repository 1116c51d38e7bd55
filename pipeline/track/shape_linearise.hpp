#pragma once

#include <array>
#include <cstddef>

#include "pipeline/track/shape.hpp"

namespace kinectlab {

/// The inner loops of ShapeFitter. Arrays are padded to a multiple of kFitLanes with s = 0.
inline constexpr std::size_t kFitLanes = 8;

struct RoundPixels {
    std::size_t size;
    const float *x, *y, *s;                    ///< ray and disparity; 0 = no reading
    float *used, *weight, *residual, *height;  ///< residual NaN where the ray does not meet it
};

/// A sphere, cylinder or cone as the rays see it, in its own frame q = Rᵀ(p - point): the camera is
/// at o, a ray's direction is linear in (x, y), and so is o x d.
struct RoundOptics {
    float o1, o2, o3;
    std::array<float, 9> direction, moment;  ///< rows of factors of x, y and 1
    float kappa, rho, c;                     ///< c = F(o)
    float by_size;                           ///< -∂F/∂size = by_size (+ by_size3 q3²)
    float by_size3;
    float least_height;
    float per_step;
};

/// Of `shape`, with the slopes by the size of `kind_of`.
[[nodiscard]] RoundOptics round_optics(
    const Shape& shape, const Shape& kind_of, const Eigen::Matrix3d& R_cam_shape, double per_step
);

/// used = 1 for readings whose rays meet the shape between two heights.
void choose_pixels(const RoundPixels& pixels, const RoundOptics& optics, double low, double high);

/// What of t1, t2, t3, ω1, ω2 and the size is unknown: 3 to 6 of them.
using RoundUnknowns = std::array<bool, 6>;

/// Over the unknowns only, in their order.
struct NormalSums {
    std::array<double, 21> products{};  ///< Σ weight·slope·slope, the lower triangle row by row
    std::array<double, 6> gradient{};   ///< Σ weight·slope·residual
    double weights = 0.0;
};

/// Residual in steps, Tukey's weight of used pixels and height of every pixel; the sums of the next
/// step.
NormalSums linearise_round(
    const RoundPixels& pixels,
    const RoundOptics& optics,
    double gate_steps,
    const RoundUnknowns& unknowns
);

struct PlanePixels {
    std::size_t size;
    const float *x, *y, *s;
    float *weight, *residual;
};
struct PlaneSums {
    double xx = 0, xy = 0, yy = 0, x = 0, y = 0, weights = 0, rx = 0, ry = 0, r = 0;
};
/// For the plane s = m·(x, y, 1), m in steps: residual, weight, and the sums of the next step.
[[nodiscard]] PlaneSums linearise_plane(
    const PlanePixels& pixels, const std::array<float, 3>& m, float gate_steps
);

}  // namespace kinectlab
