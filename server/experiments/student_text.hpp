#pragma once

#include <string>
#include <string_view>

#include "pipeline/core/error.hpp"

namespace kinectlab::experiments {

/// Text for students: paragraphs, lists and **emphasis** as in Markdown, formulas as in TeX between
/// $ or $$. Refused, with the place: HTML, links, pictures, TeX commands that do more than set
/// symbols (only kFormulaCommands pass), a $, $$, brace or \left without its partner, more than
/// 20,000 bytes, control characters.
[[nodiscard]] Result<void> check_student_text(std::string_view text, const std::string& path);

}  // namespace kinectlab::experiments
