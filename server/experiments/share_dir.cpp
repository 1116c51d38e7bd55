#include "server/experiments/share_dir.hpp"

namespace kinectlab::experiments {

std::filesystem::path share_dir() {
    // Found once: an upgrade replaces the program's file while the old one still serves.
    static const std::filesystem::path found =
        std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "share" /
        "kinectlab";
    return found;
}

}  // namespace kinectlab::experiments
