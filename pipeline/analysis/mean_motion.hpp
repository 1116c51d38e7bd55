#pragma once

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab {

/// Mean position (position_x, _y, _z in m) and velocity (velocity_x, _y, _z in m/s) of a trajectory
/// by a parabola through all positions, with the ObjectFit of it. Without a metre only the latter.
/// Errors (bad_data) as collect_position_samples and fit_residuals.
[[nodiscard]] Result<void> add_mean_motion(
    const Trajectory& object, const AnalysisConditions& conditions, AnalysisOutcome& outcome
);

}  // namespace kinectlab
