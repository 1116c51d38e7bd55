#include "server/experiments/share_dir.hpp"

namespace kinectlab::experiments {

std::filesystem::path share_dir() {
    const auto program = std::filesystem::canonical("/proc/self/exe");
    return program.parent_path().parent_path() / "share" / "kinectlab";
}

}  // namespace kinectlab::experiments
