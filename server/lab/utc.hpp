#pragma once

#include <string>

#include "pipeline/core/time.hpp"

namespace kinectlab::lab {

/// RFC 3339 in UTC to whole seconds, rounded down: "2026-11-22T09:05:00Z".
[[nodiscard]] std::string to_rfc3339(TimeNs t);

/// For sentences about a span of time, rounded to what a person would say: "45 s", "25 min".
[[nodiscard]] std::string span_text(TimeNs span);

}  // namespace kinectlab::lab
