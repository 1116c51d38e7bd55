#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"
#include "pipeline/track/object_spec.hpp"

namespace kinectlab::experiments {

/// The objects to track, from {"objects": [{"name", "method", …settings of the method…}]}:
/// the methods are those of kTrackingMethods, their settings those of object_spec.hpp by the same
/// names.
/// Errors name the JSON path, unknown keys and methods with the nearest valid one.
[[nodiscard]] Result<std::vector<ObjectSpec>> read_objects(const nlohmann::json& document);

/// The same from a file; errors name the file too.
[[nodiscard]] Result<std::vector<ObjectSpec>> load_objects(const std::filesystem::path& file);

/// One element of the list. `path` is its place in the document, for errors.
[[nodiscard]] Result<ObjectSpec> read_object(
    const nlohmann::json& element, const std::string& path
);

}  // namespace kinectlab::experiments
