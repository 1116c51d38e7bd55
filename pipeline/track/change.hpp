#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "change": whatever moved. One sample for each moving segment, biggest first, at the
/// centroid of its visible surface; none where nothing moved. The covariance is that of the
/// centroid under the sensor's noise and an outline that is known to half a pixel.
[[nodiscard]] std::unique_ptr<Tracker> make_change_tracker(
    const RgbdCamera& camera, TrackedObjects<ChangeTrackSettings> objects
);

/// There is nothing to set, and so nothing to refuse.
[[nodiscard]] inline Result<void> check(const ChangeTrackSettings&, const std::string&) {
    return {};
}

}  // namespace kinectlab
