#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"

namespace kinectlab::commands {

/// To stdout, indented.
void print_json(const nlohmann::json& document);

/// Writes beside the file and renames: what has the name is whole. Error if the folder does not
/// take it.
[[nodiscard]] Result<void> write_text_file(
    const std::filesystem::path& file, const std::string& text
);

}  // namespace kinectlab::commands
