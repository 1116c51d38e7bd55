#pragma once

#include <filesystem>

namespace kinectlab::experiments {

/// The read-only files that belong to the program (experiments, migrations, web):
/// ../share/kinectlab beside the folder of the running program, in the build tree as when
/// installed.
[[nodiscard]] std::filesystem::path share_dir();

}  // namespace kinectlab::experiments
