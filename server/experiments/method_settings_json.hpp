#pragma once

#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/track/object_spec.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {

/// Refuses a method that does not exist; the cure names the nearest and all others.
[[nodiscard]] Result<void> check_method(const std::string& method, const std::string& field);

/// The keys that stand beside "name" and "method"; none for an unknown method.
[[nodiscard]] std::vector<std::string> setting_names(const std::string& method);

/// The settings of a method that exists. What is wrong with them is told through the reader.
[[nodiscard]] MethodSettings read_settings(ObjectReader& reader, const std::string& method);

}  // namespace kinectlab::experiments
