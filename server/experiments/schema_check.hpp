#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"

namespace kinectlab::experiments {

/// Holds a definition against schema/experiment.schema.json, the one that editors get. Errors name
/// the place as a JSON path. What the definition's parts mean to each other read_definition checks.
[[nodiscard]] Result<void> check_schema(const nlohmann::json& definition);

}  // namespace kinectlab::experiments
