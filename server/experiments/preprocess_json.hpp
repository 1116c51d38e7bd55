#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"
#include "pipeline/preprocess/settings.hpp"

namespace kinectlab::experiments {

/// How frames are prepared, from {"outliers", "smoothing", "depth_cut", "reference", "change",
/// "segments"}, each optional, each {"method": NAME, …settings of the method…}; what is not said
/// keeps its default. Errors name the JSON path, unknown keys and methods with the nearest valid
/// one.
[[nodiscard]] Result<PreprocessSettings> read_preprocess(
    const nlohmann::json& element, const std::string& path
);

/// All settings in use, so that they can be read again.
[[nodiscard]] nlohmann::json to_json(const PreprocessSettings& settings);

}  // namespace kinectlab::experiments
