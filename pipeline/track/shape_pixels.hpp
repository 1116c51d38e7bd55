#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape_linearise.hpp"

namespace kinectlab {

/// The readings that a fit rests on, as rays and disparities, and what its last linearisation made
/// of each. Padded to a multiple of kFitLanes with readings of 0. Keeps its buffers.
struct ShapePixels {
    std::size_t offered = 0;  ///< without the padding
    double mean_x = 0.0, mean_y = 0.0, mean_s = 0.0;
    std::vector<float> x, y, s;  ///< ray and disparity
    std::vector<std::uint32_t> pixel;
    std::vector<float> used, weight, residual, height;  ///< see RoundPixels
    std::vector<float> chosen_before;                   ///< as `used`, of a wider rim

    /// Takes those of the pixels that have a reading; of very many every 2nd, 3rd, …
    void gather(
        const DisparityImage& image, const Pinhole& camera, std::span<const std::uint32_t> pixels
    );

    /// Noise of a reading at their mean disparity, in steps.
    [[nodiscard]] double mean_sigma(const DisparityScale& scale) const;
    /// Where the mean ray reads the mean disparity, m.
    [[nodiscard]] Eigen::Vector3d middle(const DisparityScale& scale) const;

    [[nodiscard]] RoundPixels round();
    [[nodiscard]] PlanePixels flat();
};

}  // namespace kinectlab
