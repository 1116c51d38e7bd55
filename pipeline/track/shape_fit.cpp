#include "pipeline/track/shape_fit.hpp"

#include <cmath>

#include "pipeline/track/plane_fit.hpp"

namespace kinectlab {

ShapeFitter::ShapeFitter(const RgbdCamera& camera)
    : camera_(camera.depth), scale_(camera), noise_(camera.depth) {}

/// Whether there is enough to fit.
bool ShapeFitter::gather(
    const DisparityImage& image, std::span<const std::uint32_t> pixels, const Shape& guess
) {
    if (pixels.empty() || !guess.point.allFinite() || !guess.axis.allFinite() ||
        !std::isfinite(guess.size))
        return false;
    pixels_.gather(image, camera_, pixels);
    return static_cast<double>(pixels_.offered) >= kFewestFitPixels;
}

std::optional<ShapeFit> ShapeFitter::fit(
    const DisparityImage& image,
    std::span<const std::uint32_t> pixels,
    const Shape& guess,
    bool fixed_size,
    FitStart start
) {
    if (!gather(image, pixels, guess)) return std::nullopt;
    if (guess.kind == ShapeKind::plane) return fit_plane(pixels_, camera_, scale_, guess, noise_);
    return fit_round(pixels_, camera_, scale_, guess, start, fixed_size, noise_);
}

double ShapeFitter::misfit(
    const DisparityImage& image, std::span<const std::uint32_t> pixels, const Shape& guess
) {
    if (!gather(image, pixels, guess)) return 1.0;
    return guess.kind == ShapeKind::plane ? misfit_plane(pixels_, scale_, guess)
                                          : misfit_round(pixels_, camera_, scale_, guess);
}

}  // namespace kinectlab
