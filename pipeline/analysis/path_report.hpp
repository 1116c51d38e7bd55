#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/path_fit.hpp"
#include "pipeline/analysis/path_stretch.hpp"

namespace kinectlab {

/// The fit at the times of all of a trajectory's samples; NaN outside the stretch that it rests on.
/// `fit` is of that stretch's samples alone. The model's times are those of the samples.
[[nodiscard]] ObjectFit path_for_plots(
    const Trajectory& trajectory,
    std::span<const PositionSample> samples,
    const Stretch& stretch,
    const PathModel& model,
    const PathFit& fit
);

/// duration_s and gap_share of the stretch, start_s of its beginning after the first sample.
[[nodiscard]] std::map<std::string, double> stretch_facts(
    std::span<const PositionSample> samples, const Stretch& stretch
);

/// For a student: what of the recording was left out and why (`motion`: "a free flight"), missing
/// frames, outliers, and in metres a scatter beyond what the tracker expects.
[[nodiscard]] std::vector<std::string> stretch_warnings(
    std::span<const PositionSample> samples,
    const Stretch& stretch,
    const PathFit& fit,
    const std::string& motion,
    bool metric
);

/// Speed of the fit as a line, of the trajectory's own velocities as points, against time; along
/// `direction`, or its size if that is zero.
[[nodiscard]] Plot velocity_plot(
    const ObjectFit& fit, const Trajectory& trajectory, const Eigen::Vector3d& direction
);

/// Labels in pixels where the positions are.
void label_in_pixels(std::vector<Plot>& plots);

/// The largest extent of the positions along an axis, m; robust against single wild ones.
[[nodiscard]] double extent_of(std::span<const PositionSample> samples);

}  // namespace kinectlab
