#pragma once

#include <string_view>

#include "pipeline/core/error.hpp"
#include "pipeline/simulate/simulated_rig.hpp"

namespace kinectlab::simulated_rig {

constexpr std::string_view kDefaultUri = "sim://pendulum";

/// "sim://NAME" or "sim://NAME?seed=7&noise=kinect". NAME: letters, digits, '-' and '_'; a rig is
/// its whole URI. Another scheme is `not_found`; what is wrong in one of ours is
/// `invalid_argument`.
[[nodiscard]] Result<simulate::RigSettings> parse_uri(std::string_view uri);

}  // namespace kinectlab::simulated_rig
