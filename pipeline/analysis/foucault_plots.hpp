#pragma once

#include "pipeline/analysis/swing_plots.hpp"

namespace kinectlab {

/// "plane_angle": by how much the swing's plane has turned since the start, in degrees against the
/// clock as seen from above: the main direction of the positions of each five periods, measured and
/// fitted.
[[nodiscard]] Plot plane_angle_plot(const FollowedSwing& swing, const SwingAxes& axes);

/// "ellipse": half the orbit's width over time, mm, above zero against the clock: what of the
/// motion across the plane is a quarter period away from the motion along it, in each five periods.
[[nodiscard]] Plot ellipse_plot(const FollowedSwing& swing, const SwingAxes& axes);

}  // namespace kinectlab
