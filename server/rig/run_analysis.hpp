#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/core/trajectory.hpp"
#include "pipeline/sensor/frame_source.hpp"
#include "server/lab/run.hpp"

namespace kinectlab::rig {

struct RunMeasured {
    lab::Run run;
    SourceInfo source;
    std::map<std::string, std::vector<TrackSample>> samples;  ///< by object, in order of time
};

struct RunAnalysis {
    std::string result_json;  ///< the project's result object
    std::string fit_json;     ///< {"objects": [{"object", "t_s", "measured", "fit", "residual"}]}
    std::string plots_json;   ///< as experiments::Evaluation has them
    std::vector<std::string> warnings;
};

/// All of a run's poses at their best: gaps filled, velocities from both sides.
[[nodiscard]] std::vector<Trajectory> final_trajectories(const RunMeasured& measured);

/// From what a run measured to its result by the definition that it was made with, with the
/// provenance of every number. Errors as the experiment's analysis.
[[nodiscard]] Result<RunAnalysis> analyse_run(
    const RunMeasured& measured, const std::vector<Trajectory>& trajectories
);

}  // namespace kinectlab::rig
