#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/analysis/plot.hpp"
#include "pipeline/core/measurement.hpp"

namespace kinectlab::plots {

/// A stored plot as evaluations write it; null is NaN. What is missing stays empty.
[[nodiscard]] Plot plot_from_json(const nlohmann::json& plot);

/// The "results" of a stored result.
[[nodiscard]] std::vector<Measurement> measurements_from_json(const nlohmann::json& results);

}  // namespace kinectlab::plots
