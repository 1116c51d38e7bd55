#include "pipeline/track/sphere_detect.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/track/sphere_candidate.hpp"

namespace kinectlab {
namespace {

// What is accepted as a sphere. Each bound was chosen so that a clean ball passes far from it.
constexpr double kMinSupport = 0.25;      // of a segment's points: a hand may hold the ball
constexpr double kMinInlierShare = 0.70;  // of the readings inside the outline
constexpr double kMinVisible = 0.45;      // of the pixels that it should cover
constexpr double kMinAlone = 0.50;        // of the pixels around: strings and magnets touch it
constexpr double kMaxRmsSigmas = 3.0;
constexpr double kMaxRadiusShareU = 0.15;  // a free radius less sure than this is no measurement

constexpr double kMostRadiusNoise = 0.01;  // of the radius, a pixel's noise over the root of all

}  // namespace

SphereDetector::SphereDetector(const RgbdCamera& camera)
    : camera_(camera), scale_(camera), fitter_(camera) {
    rest_.reserve(static_cast<std::size_t>(camera.depth.width * camera.depth.height));
}

std::optional<SphereFit> SphereDetector::find(
    const RgbdFrame& frame, MovedPixels pixels, const SphereSettings& settings, const Taken& taken
) {
    const MovedPixels free = without_taken(frame, pixels, taken);
    const SurfaceSample sample(frame.depth, free, camera_.depth, scale_);
    const auto candidate = sphere_candidate(sample.points(), settings, scale_);
    if (!candidate || support(*candidate, sample.points(), scale_) < kMinSupport)
        return std::nullopt;
    auto fit = fitter_.fit(frame.depth, *candidate, settings.radius_m.has_value());
    return fit && is_sphere(*fit, settings) ? fit : std::nullopt;
}

// The limit is told from the known radius, because a free one is surest where it errs to be small.
std::optional<SphereFit> SphereDetector::with_free_radius(
    const RgbdFrame& frame, const Sphere& known
) {
    const double z = known.centre_cam.z();
    const double noise_m = scale_.sigma_at(scale_.steps_at(z)) * scale_.inverse_depth_step * z * z;
    const double root_of_pixels = camera_.depth.fx * known.radius / z * std::sqrt(std::numbers::pi);
    if (noise_m > kMostRadiusNoise * known.radius * root_of_pixels) return std::nullopt;
    auto fit = fitter_.fit(frame.depth, known, false);
    return fit && fit->radius_u > 0.0 ? fit : std::nullopt;
}

Eigen::Vector3d SphereDetector::point(const RgbdFrame& frame, std::uint32_t pixel) const {
    const auto column = static_cast<int>(pixel) % camera_.depth.width;
    const auto row = static_cast<int>(pixel) / camera_.depth.width;
    return camera_.depth.ray(column, row) * (camera_.depth_unit_m * frame.depth[pixel]);
}

MovedPixels SphereDetector::without_taken(
    const RgbdFrame& frame, MovedPixels pixels, const Taken& taken
) {
    if (taken.claimed.empty() && taken.passed_by.empty()) return pixels;
    rest_.clear();
    for (const auto pixel : pixels) {
        const Eigen::Vector3d p_cam = point(frame, pixel);
        const auto is_on = [&](const Sphere& s) {
            return (p_cam - s.centre_cam).norm() < 1.2 * s.radius;
        };
        if (std::none_of(taken.claimed.begin(), taken.claimed.end(), is_on) &&
            std::none_of(taken.passed_by.begin(), taken.passed_by.end(), is_on))
            rest_.push_back(pixel);
    }
    return rest_;
}

bool SphereDetector::is_sphere(const SphereFit& fit, const SphereSettings& settings) const {
    const double z = fit.sphere.centre_cam.z();
    const bool radius_fits =
        settings.radius_m ||
        (fit.sphere.radius >= settings.min_radius_m && fit.sphere.radius <= settings.max_radius_m &&
         fit.radius_u <= kMaxRadiusShareU * fit.sphere.radius);
    return radius_fits && fit.quality.inlier_share >= kMinInlierShare &&
           fit.visible_share >= kMinVisible && fit.alone_share >= kMinAlone &&
           fit.quality.rms_steps <= kMaxRmsSigmas * scale_.sigma_at(scale_.steps_at(z));
}

}  // namespace kinectlab
