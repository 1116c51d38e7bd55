#include "pipeline/preprocess/cleaner.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

void drop_nearer_than(std::vector<std::uint16_t>& depth, double counts) {
    for (auto& reading : depth)
        if (reading < counts) reading = 0;
}

Result<void> remove_outliers(
    RgbdFrame& frame, const RgbdCamera& camera, const OutlierSettings& settings
) {
    const auto readings =
        frame.depth.size() -
        static_cast<std::size_t>(std::count(frame.depth.begin(), frame.depth.end(), 0));
    if (readings <= static_cast<std::size_t>(settings.neighbours)) {
        std::fill(frame.depth.begin(), frame.depth.end(), std::uint16_t{0});
        return {};
    }
    const auto outliers =
        find_outliers(cloud_from(frame, camera.depth, camera.depth_unit_m), settings);
    if (!outliers) return tl::unexpected(outliers.error());
    for (std::size_t i = 0; i < frame.depth.size(); ++i)
        if (outliers->mask[i] != 0) frame.depth[i] = 0;
    return {};
}

Result<void> smooth(
    RgbdFrame& frame, const RgbdCamera& camera, const MovingLeastSquaresSettings& settings
) {
    drop_nearer_than(frame.depth, nearest_smoothed_m(camera, settings) / camera.depth_unit_m);
    const auto smoothed = smooth_organised(
        cloud_from(frame, camera.depth, camera.depth_unit_m), camera.depth, settings
    );
    if (!smoothed) return tl::unexpected(smoothed.error());
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
        const double counts = std::round(smoothed->cloud.z[i] / camera.depth_unit_m);
        if (frame.depth[i] != 0 && std::isfinite(counts))
            frame.depth[i] = static_cast<std::uint16_t>(std::clamp(counts, 1.0, 65535.0));
    }
    return {};
}

}  // namespace

double nearest_smoothed_m(const RgbdCamera& camera, const MovingLeastSquaresSettings& settings) {
    // One pixel less than the most, for what rounding does.
    return settings.radius_m * std::max(camera.depth.fx, camera.depth.fy) / (kMostPixels - 1);
}

FrameCleaner::FrameCleaner(const RgbdCamera& camera, const PreprocessSettings& settings)
    : camera_(camera), outliers_(settings.outliers), smoothing_(settings.smoothing) {
    // What the sensor's noise is decides what belongs to one surface: dz = sigma step z².
    if (smoothing_)
        smoothing_->depth_noise_per_m = camera.noise.sigma_steps * camera.noise.inverse_depth_step;
}

Result<const RgbdFrame*> FrameCleaner::clean(const RgbdFrame& frame) {
    if (!outliers_ && !smoothing_) return &frame;
    cleaned_ = frame;
    if (outliers_)
        if (auto ok = remove_outliers(cleaned_, camera_, *outliers_); !ok)
            return tl::unexpected(ok.error());
    if (smoothing_)
        if (auto ok = smooth(cleaned_, camera_, *smoothing_); !ok)
            return tl::unexpected(ok.error());
    return &cleaned_;
}

}  // namespace kinectlab
