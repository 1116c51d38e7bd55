#pragma once

#include <string>
#include <vector>

#include "pipeline/analysis/analysis.hpp"
#include "server/experiments/evaluate.hpp"

namespace kinectlab::experiments {

/// What an analysis is told besides its objects.
struct SeenSettings {
    AnalysisSettings values;
    std::vector<std::string> warnings;  ///< what was to be seen in the run and was not
};

/// A plane's angle to the level, °: between its normal, the mean over all frames, and the vertical.
struct PlaneTilt {
    double deg = 0.0;
    /// Standard uncertainty: how surely one frame shows it, which the camera's fixed pattern keeps
    /// averaging from making smaller; and how level the lab frame is.
    double u_deg = 0.0;
};
[[nodiscard]] Result<PlaneTilt> tilt_of(
    const std::vector<Trajectory>& all, const std::string& object, double level_u_rad
);

/// The settings of a definition's analysis with a run's values. One that asks for a plane which was
/// not seen is left out with a warning where the analysis can do without it, else an error.
[[nodiscard]] Result<SeenSettings> settings_of(const Seen& seen);

}  // namespace kinectlab::experiments
