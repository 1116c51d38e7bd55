#include "pipeline/track/shape_fit.hpp"

#include <cmath>

#include "pipeline/track/plane_fit.hpp"
#include "pipeline/track/round_fit.hpp"

namespace kinectlab {

ShapeFitter::ShapeFitter(const RgbdCamera& camera)
    : camera_(camera.depth), scale_(camera), noise_(camera.depth) {}

std::optional<ShapeFit> ShapeFitter::fit(
    const DisparityImage& image,
    std::span<const std::uint32_t> pixels,
    const Shape& guess,
    bool fixed_size
) {
    if (pixels.empty() || !guess.point.allFinite() || !guess.axis.allFinite() ||
        !std::isfinite(guess.size))
        return std::nullopt;
    pixels_.gather(image, camera_, pixels);
    if (static_cast<double>(pixels_.offered) < kFewestFitPixels) return std::nullopt;
    if (guess.kind == ShapeKind::plane) return fit_plane(pixels_, camera_, scale_, guess, noise_);
    return fit_round(pixels_, camera_, scale_, guess, fixed_size, noise_);
}

}  // namespace kinectlab
