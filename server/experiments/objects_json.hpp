#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"
#include "pipeline/run/tracking_plan.hpp"
#include "pipeline/track/object_spec.hpp"

namespace kinectlab::experiments {

/// The objects to track, from {"objects": [{"name", "method", …settings of the method…}],
/// "preprocess": {…}}: the methods are those of kTrackingMethods, their settings those of
/// object_spec.hpp by the same names; "preprocess" is optional, see preprocess_json.hpp.
/// Errors name the JSON path, unknown keys and methods with the nearest valid one.
[[nodiscard]] Result<TrackingPlan> read_tracking_plan(const nlohmann::json& document);

/// The same from a file; errors name the file too.
[[nodiscard]] Result<TrackingPlan> load_tracking_plan(const std::filesystem::path& file);

/// One element of the list. `path` is its place in the document, for errors.
[[nodiscard]] Result<ObjectSpec> read_object(
    const nlohmann::json& element, const std::string& path
);

}  // namespace kinectlab::experiments
