#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/correlated_noise.hpp"
#include "pipeline/track/fitted_shape.hpp"
#include "pipeline/track/round_fit.hpp"
#include "pipeline/track/shape_pixels.hpp"
#include "pipeline/track/shape_search.hpp"

namespace kinectlab {

/// Fits a shape to pixels along the viewing rays, in disparity, where the noise is the same for
/// every pixel: maximum likelihood for what is not an outlier. Learns from picture to picture how
/// far neighbouring pixels err together, for the covariance. Keeps its buffers: no allocation once
/// they have grown. Not thread-safe.
class ShapeFitter {
public:
    explicit ShapeFitter(const RgbdCamera& camera);

    /// Among `pixels` may be others than the shape's. A fixed size is known and stays. Nothing if
    /// too few pixels carry the fit, they do not determine the shape, or it does not settle.
    [[nodiscard]] std::optional<ShapeFit> fit(
        const DisparityImage& image,
        std::span<const std::uint32_t> pixels,
        const Shape& guess,
        bool fixed_size,
        FitStart start = FitStart::guess
    );

    /// How badly the best of some guesses, its size free, explains the pixels: ShapeFit::cost after
    /// a few steps; 1 if they lead nowhere. In a fraction of fit()'s time, and teaches nothing
    /// about the noise.
    [[nodiscard]] double least_misfit(
        const DisparityImage& image,
        std::span<const std::uint32_t> pixels,
        std::span<const ShapeCandidate> guesses,
        double hopeless
    );

private:
    Pinhole camera_;
    DisparityScale scale_;
    ShapePixels pixels_;
    CorrelatedNoise noise_;
};

}  // namespace kinectlab
