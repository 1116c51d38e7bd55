#pragma once

#include <string>
#include <vector>

#include "pipeline/core/trajectory.hpp"

namespace kinectlab::commands {

/// All poses as CSV, in the order of time, objects of one time in the order given.
[[nodiscard]] std::string poses_to_csv(const std::vector<Trajectory>& trajectories);

}  // namespace kinectlab::commands
