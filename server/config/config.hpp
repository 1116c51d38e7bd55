#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/core/error.hpp"

namespace kinectlab::config {

struct RigConfig {
    std::string id;    ///< in URLs: lower-case letters, digits and dashes
    std::string name;  ///< for people
    std::string uri;   ///< of the device as OpenNI2 lists it, e.g. "sim://rig-1"
    /// Empty: a simulated rig does all that come with the program, a real one the pendulum's.
    std::vector<std::string> experiments;
};

struct Address {
    std::string host = "127.0.0.1";  ///< an IP address; 0.0.0.0 or :: for all of this machine's
    std::uint16_t port = 8080;       ///< 0: any free one
};

/// Everything that can be set, read once at the start.
struct Config {
    Address listen;
    std::filesystem::path data_dir;  ///< default: kinectlab under $XDG_DATA_HOME or ~/.local/share
    std::string log_level = "info";  ///< debug | info | warn | error
    std::vector<RigConfig> rigs;     ///< default: two simulated ones, "rig-1" and "rig-2"
};

using Environment = std::map<std::string, std::string>;

/// Defaults, then the file, then the environment: KINECTLAB_LISTEN, KINECTLAB_DATA_DIR,
/// KINECTLAB_LOG_LEVEL. The file is JSON with the members of Config. Errors name the key; an
/// unknown key, or a variable that looks like a slip of the pen, comes with the nearest valid name.
[[nodiscard]] Result<Config> read_config(
    const std::optional<std::filesystem::path>& file, const Environment& environment
);

/// "ADDRESS:PORT", "[IPv6]:PORT" or ":PORT". Error on `listen`.
[[nodiscard]] Result<Address> parse_address(std::string_view text);

/// All variables of this process.
[[nodiscard]] Environment environment();

}  // namespace kinectlab::config
