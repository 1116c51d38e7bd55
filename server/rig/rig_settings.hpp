#pragma once

#include <string>
#include <vector>

namespace kinectlab::rig {

struct RigSettings {
    std::string id;    ///< in URLs: "rig-1"
    std::string name;  ///< for people
    std::string uri;   ///< of the device, e.g. "sim://rig-1?seed=1"
    std::vector<std::string> experiments{"pendulum"};
};

}  // namespace kinectlab::rig
