#pragma once

#include <nlohmann/json_fwd.hpp>

#include "server/experiments/definition.hpp"

namespace kinectlab::experiments {

/// The members of a definition that say what is done and made of it: sequence, duration, early end,
/// analysis, plots, acceptance. `definition` holds its parameters and objects already; errors have
/// the JSON path.
[[nodiscard]] Result<void> read_parts(const nlohmann::json& document, Definition& definition);

void write_parts(const Definition& definition, nlohmann::json& document);

}  // namespace kinectlab::experiments
