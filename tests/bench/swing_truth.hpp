#pragma once

#include <map>
#include <string>

#include "tests/bench/pendulum_positions.hpp"

namespace kinectlab::bench {

/// What the results of the swing truly are, by their names.
[[nodiscard]] std::map<std::string, double> truth_of(const PositionRun& run);

}  // namespace kinectlab::bench
