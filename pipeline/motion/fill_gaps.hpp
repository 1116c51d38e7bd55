#pragma once

#include <span>

#include "pipeline/core/trajectory.hpp"

namespace kinectlab {

/// Marks a sample as lost: position, velocity, acceleration, angular velocity, their uncertainties
/// and covariance NaN.
void set_lost(MotionSample& sample);

/// Gives the lost samples between two measured ones no more than max_step_s apart a place, and
/// marks them interpolated: a cubic Hermite spline through both positions and velocities (a
/// straight line where a velocity is not known), the short great arc between orientations. Their
/// covariance is what the neighbours' uncertainty makes of it, at least the worse neighbour's.
/// Others stay lost.
void fill_gaps(std::span<MotionSample> samples, double max_step_s);

}  // namespace kinectlab
