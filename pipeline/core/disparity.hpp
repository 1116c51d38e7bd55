#pragma once

#include <cmath>
#include <cstdint>

#include "pipeline/core/camera.hpp"

namespace kinectlab {

/// Depth counts ↔ disparity. Disparity here is inverse depth in the sensor's own steps, zero at
/// infinity and larger when nearer: the sensor's noise is the same everywhere in this unit.
struct DisparityScale {
    double product = 0.0;             ///< steps x counts: disparity = product / depth
    double counts_per_m = 0.0;        ///< depth counts for each metre
    double sigma_steps = 0.0;         ///< the sensor's noise
    double inverse_depth_step = 0.0;  ///< 1/m for each step

    explicit DisparityScale(const RgbdCamera& camera)
        : product(1.0 / (camera.noise.inverse_depth_step * camera.depth_unit_m)),
          counts_per_m(1.0 / camera.depth_unit_m),
          sigma_steps(camera.noise.sigma_steps),
          inverse_depth_step(camera.noise.inverse_depth_step) {}

    /// Disparity in steps of a depth that is not 0.
    [[nodiscard]] double steps(std::uint16_t depth) const { return product / depth; }
    [[nodiscard]] double steps_at(double z_m) const { return 1.0 / (inverse_depth_step * z_m); }
    [[nodiscard]] double metres(double steps) const { return 1.0 / (inverse_depth_step * steps); }

    /// What one rounded depth count adds to the noise at this disparity, in steps.
    [[nodiscard]] double rounding_steps(double steps) const {
        constexpr double kUniformSigma = 0.28867513;  // of a rounding error, 1/sqrt(12)
        return kUniformSigma * steps * steps / product;
    }
    /// Noise of a reading at this disparity in steps: the sensor's own and the rounding to counts.
    [[nodiscard]] double sigma_at(double steps) const {
        return std::hypot(sigma_steps, rounding_steps(steps));
    }
};

}  // namespace kinectlab
