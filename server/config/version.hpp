#pragma once

namespace kinectlab::config {

/// The program's version, e.g. "0.1.0", as it stands in CMakeLists.txt.
[[nodiscard]] const char* version();

}  // namespace kinectlab::config
