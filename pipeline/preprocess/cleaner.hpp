#pragma once

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/preprocess/settings.hpp"

namespace kinectlab {

/// Readings nearer than this are left out by smoothing: the radius would be more than kMostPixels.
[[nodiscard]] double nearest_smoothed_m(
    const RgbdCamera& camera, const MovingLeastSquaresSettings& settings
);

/// Outliers removed and surfaces smoothed in a whole depth picture, where the settings ask for it.
/// Not thread-safe.
class FrameCleaner {
public:
    FrameCleaner(const RgbdCamera& camera, const PreprocessSettings& settings);

    /// The frame itself where there is nothing to do, else a copy that is valid until the next
    /// call. With statistical outliers, a picture of no more readings than neighbours becomes
    /// empty: none of them has enough. With smoothing, readings so near that the radius is more
    /// than kMostPixels become 0.
    [[nodiscard]] Result<const RgbdFrame*> clean(const RgbdFrame& frame);

private:
    RgbdCamera camera_;
    std::optional<OutlierSettings> outliers_;
    std::optional<MovingLeastSquaresSettings> smoothing_;
    RgbdFrame cleaned_;
};

}  // namespace kinectlab
