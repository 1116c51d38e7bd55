#pragma once

#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Method "change": whatever moved, as separate things that keep their identity (Identities). One
/// sample for each thing known, at the centroid of its visible surface: tracked, or lost while
/// nothing of it is seen. The covariance is that of the centroid under the sensor's noise, what the
/// outline does from frame to frame (OutlineError), and what another thing hides.
[[nodiscard]] std::unique_ptr<Tracker> make_change_tracker(
    const RgbdCamera& camera, TrackedObjects<ChangeTrackSettings> objects
);

/// Refuses a memory that is not from 0 to 60 s.
[[nodiscard]] Result<void> check(const ChangeTrackSettings& settings, const std::string& path);

}  // namespace kinectlab
