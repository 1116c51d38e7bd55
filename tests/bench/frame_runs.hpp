#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/core/trajectory.hpp"
#include "pipeline/simulate/simulate_run.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/evaluate.hpp"

namespace kinectlab::bench {

/// One of the program's own experiments, with what it is done with here.
struct FrameExperiment {
    experiments::Definition definition;
    experiments::Values values;
    double seconds = 0.0;  ///< of free motion
};

/// Throws if there is none of this name, or a value is refused.
[[nodiscard]] FrameExperiment frame_experiment(
    const std::string& id, double seconds, const experiments::Values& changes = {}
);

[[nodiscard]] simulate::RunSettings run_settings_of(const FrameExperiment& experiment);

/// What the chain saw of a rendered run from its release on, and what was there to be seen.
struct FrameRun {
    std::vector<Trajectory> objects;
    std::vector<simulate::Truth> truth;  ///< at each sample's time
};

/// Renders with a Kinect's noise, learns the scene and tracks as the definition says. Throws.
[[nodiscard]] FrameRun seen_run(const FrameExperiment& experiment, std::uint64_t seed);

/// By the definition's own settings, but for `overrides`. Throws.
[[nodiscard]] AnalysisOutcome analysed(
    const FrameExperiment& experiment,
    const FrameRun& run,
    const std::map<std::string, std::optional<double>>& overrides = {}
);

}  // namespace kinectlab::bench
