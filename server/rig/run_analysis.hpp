#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/core/trajectory.hpp"
#include "pipeline/sensor/frame_source.hpp"
#include "server/experiments/definition.hpp"
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

/// What is to be different when a stored run is analysed once more.
struct Reanalysis {
    experiments::Definition definition;
    std::map<std::string, std::optional<double>> settings;  ///< see experiments::Seen::overrides
    std::string person;  ///< who asked for it, for the provenance
    TimeNs at = 0;
};

/// A stored run from its stored poses, with camera and clock as `earlier`, a result of the same
/// run, has them; without one they are taken to be a Kinect's. Errors as the analysis.
[[nodiscard]] Result<RunAnalysis> analyse_again(
    const lab::Run& run,
    const std::vector<Trajectory>& poses,
    const std::string& earlier,
    const Reanalysis& wish
);

}  // namespace kinectlab::rig
