#pragma once

#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/track/shape_pixels.hpp"

namespace kinectlab {

/// Learns from picture to picture how far neighbouring pixels err together. Not thread-safe.
class CorrelatedNoise {
public:
    explicit CorrelatedNoise(const Pinhole& camera);

    /// By how much the variance of a fit with so many unknowns is more than σ² promises: the
    /// residuals' own scatter, and what neighbouring pixels err together. Sums over blocks larger
    /// than a sensor's correlation window scatter by as much more than independent errors would let
    /// them as the fit does.
    [[nodiscard]] double inflation(const ShapePixels& pixels, double sigma, double unknowns);

private:
    int width_, block_columns_;
    std::vector<double> sum_, squares_;         // of each block
    double of_blocks_ = 0.0, of_pixels_ = 0.0;  // fading
};

}  // namespace kinectlab
