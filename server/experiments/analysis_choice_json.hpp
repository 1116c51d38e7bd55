#pragma once

#include <nlohmann/json_fwd.hpp>

#include "server/experiments/definition.hpp"

namespace kinectlab::experiments {

/// The analysis with its objects and settings, the plots and the acceptance checks of a definition
/// whose parameters and objects are known. Errors have the JSON path.
[[nodiscard]] Result<void> read_analysis_choice(
    const nlohmann::json& document, Definition& definition
);

void write_analysis_choice(const Definition& definition, nlohmann::json& document);

}  // namespace kinectlab::experiments
