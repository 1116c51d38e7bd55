#pragma once

#include <string>
#include <string_view>

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// One line: the apparatus' name, then name=value for each parameter, with spaces between.
[[nodiscard]] std::string to_text(const ApparatusSettings& settings);

/// Reads that line. Refuses what is not of this form and a parameter that is there twice; whether
/// the apparatus exists and takes the values is for make_apparatus() to say.
[[nodiscard]] Result<ApparatusSettings> parse_apparatus(std::string_view text);

}  // namespace kinectlab::simulate
