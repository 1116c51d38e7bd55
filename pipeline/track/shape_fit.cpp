#include "pipeline/track/shape_fit.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/track/plane_fit.hpp"

namespace kinectlab {

namespace {

bool is_finite(const Shape& shape) {
    return shape.point.allFinite() && shape.axis.allFinite() && std::isfinite(shape.size);
}

}  // namespace

ShapeFitter::ShapeFitter(const RgbdCamera& camera)
    : camera_(camera.depth), scale_(camera), noise_(camera.depth) {}

std::optional<ShapeFit> ShapeFitter::fit(
    const DisparityImage& image,
    std::span<const std::uint32_t> pixels,
    const Shape& guess,
    bool fixed_size,
    FitStart start
) {
    if (pixels.empty() || !is_finite(guess)) return std::nullopt;
    pixels_.gather(image, camera_, pixels);
    if (static_cast<double>(pixels_.offered) < kFewestFitPixels) return std::nullopt;
    if (guess.kind == ShapeKind::plane) return fit_plane(pixels_, camera_, scale_, guess, noise_);
    return fit_round(pixels_, camera_, scale_, guess, start, fixed_size, noise_);
}

double ShapeFitter::least_misfit(
    const DisparityImage& image,
    std::span<const std::uint32_t> pixels,
    std::span<const ShapeCandidate> guesses,
    double hopeless
) {
    if (pixels.empty() || guesses.empty()) return 1.0;
    pixels_.gather(image, camera_, pixels);
    if (static_cast<double>(pixels_.offered) < kFewestFitPixels) return 1.0;
    double least = 1.0;
    for (const auto& guess : guesses) {
        const bool plane = guess.shape.kind == ShapeKind::plane;
        const double cost = plane ? misfit_plane(pixels_, scale_, guess.shape)
                                  : misfit_round(pixels_, camera_, scale_, guess.shape);
        least = std::min(least, cost);
        if (cost > hopeless) break;
    }
    return least;
}

}  // namespace kinectlab
