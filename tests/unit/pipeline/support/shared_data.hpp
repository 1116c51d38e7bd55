#pragma once

#include <cstdlib>
#include <filesystem>

namespace kinectlab::test {

/// Recordings of real sensors, which are no part of the project; tests skip where they are missing.
inline std::filesystem::path shared_data() {
    if (const char* given = std::getenv("KINECTLAB_SHARED_DATA")) return given;
    return std::filesystem::path(KINECTLAB_SOURCE_DIR) / "../shared/data";
}

}  // namespace kinectlab::test
