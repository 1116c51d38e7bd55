#pragma once

#include <vector>

#include "pipeline/core/cloud.hpp"

namespace kinectlab {

/// For every point the mean distance to its `neighbours` nearest others, m; 0 for points without a
/// reading. Needs more points with a reading than neighbours. Exact, and rounded as PCL 1.13 does.
[[nodiscard]] std::vector<float> mean_distances(const Cloud& cloud, int neighbours);

}  // namespace kinectlab
