#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pipeline/analysis/analysis.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/result_json.hpp"

namespace kinectlab::experiments {

/// A run as it was seen, with the values that it was done with.
struct Seen {
    const Definition& definition;
    const Values& values;
    const std::vector<Trajectory>& trajectories;  ///< one for each object, found by its name
    AnalysisConditions conditions;
    /// Instead of what the definition says; a setting without a value is taken away.
    std::map<std::string, std::optional<double>> overrides;
};

/// What came of it, in the shapes that are stored and sent.
struct Evaluation {
    AnalysisOutcome outcome;
    /// {"experiment","parameters","analysis","results","facts","acceptance","accepted","warnings",
    /// "notes","provenance"}
    nlohmann::json result;
    nlohmann::json fit;    ///< {"objects":[{"object","t_s","measured","fit","residual",…}]}
    nlohmann::json plots;  ///< [{"name","title","x_label","y_label","equal_axes","series"}]
};

/// The definition's analysis on its objects, its acceptance checks and plots. `provenance` is
/// completed with what the fit knows; times in `fit` count from `zero`. Errors as the analysis; an
/// object that was never seen is bad_data.
[[nodiscard]] Result<Evaluation> evaluate(const Seen& seen, Provenance provenance, TimeNs zero);

}  // namespace kinectlab::experiments
