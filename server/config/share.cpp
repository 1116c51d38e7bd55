#include "server/config/share.hpp"

namespace kinectlab::config {

std::filesystem::path share_dir() {
    const auto program = std::filesystem::canonical("/proc/self/exe");
    return program.parent_path().parent_path() / "share" / "kinectlab";
}

}  // namespace kinectlab::config
