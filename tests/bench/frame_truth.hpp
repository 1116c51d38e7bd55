#pragma once

#include <map>
#include <string>

#include "tests/bench/frame_runs.hpp"

namespace kinectlab::bench {

/// What the results of a simulated run truly are, by their names, as far as that is known. Some
/// are those of the first position that the analysis used, which is among its facts.
[[nodiscard]] std::map<std::string, double> truth_of(
    const FrameExperiment& experiment, const FrameRun& run, const AnalysisOutcome& outcome
);

}  // namespace kinectlab::bench
