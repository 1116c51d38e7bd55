#pragma once

#include <filesystem>
#include <string>

#include "server/net/router.hpp"

namespace kinectlab::net {

/// Serves the files under `root`. Files under assets/ carry their content's hash in their name and
/// never change; all others are asked for again with their ETag. FILE.br or FILE.gz beside a file
/// is sent to whoever takes it. An address without a dot in its last part belongs to the page's own
/// routes and gets index.html; below /`reserved` there are no files.
[[nodiscard]] Handler static_files(std::filesystem::path root, std::string reserved);

}  // namespace kinectlab::net
