#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "server/experiments/definition.hpp"

/// What the members of a definition refer to each other by.
namespace kinectlab::experiments {

/// "sequence[2]"
[[nodiscard]] std::string element_of(const char* list, std::size_t i);

[[nodiscard]] bool among(const std::vector<std::string>& names, const std::string& name);

/// The error at `path` for a name that is none of these, with the nearest one.
[[nodiscard]] tl::unexpected<Error> not_among(
    const std::string& path, const std::string& name, const std::vector<std::string>& names
);

[[nodiscard]] std::vector<std::string> object_names(const Definition& definition);

/// A number, or {"parameter": NAME} of one that the definition has.
[[nodiscard]] Result<Setting> read_setting(
    const nlohmann::json& value, const std::string& path, const Definition& definition
);
[[nodiscard]] nlohmann::json setting_json(const Setting& setting);

}  // namespace kinectlab::experiments
