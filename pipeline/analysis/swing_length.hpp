#pragma once

#include <span>

#include "pipeline/analysis/position_samples.hpp"

namespace kinectlab {

/// For how long the object moved in one go, s: the longest stretch without a rest of a third of
/// `period`. A rest is what stays within an eighth of the whole path's width; a pendulum at a
/// turning point leaves that sooner. Also across gaps.
[[nodiscard]] double longest_motion_s(std::span<const PositionSample> samples, double period);

}  // namespace kinectlab
