#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/core/cloud.hpp"

namespace kinectlab {

/// Statistical outlier removal (the paper's III.B.1).
struct OutlierSettings {
    int neighbours = 100;       ///< K, 1 to kMostNeighbours; the paper's value
    double sigma_factor = 1.0;  ///< threshold = mean + factor x σ, at least 0; the paper's value

    static constexpr int kMostNeighbours = 4096;
};

struct Outliers {
    std::vector<std::uint8_t> mask;    ///< 1 = outlier; as many as points
    std::vector<float> mean_distance;  ///< m, to the K nearest; 0 for points without a reading
    double threshold_m = 0.0;
    std::size_t count = 0;
};

/// Marks the points whose mean distance to their K nearest neighbours is more than sigma_factor
/// standard deviations above the mean of all. Neighbours are exact; sums and roundings are those of
/// PCL 1.13, so that the mask is the same. Points without a reading are never outliers and weigh
/// as zeros in the sums, as there. Organised clouds are searched in windows of pixels, others in a
/// k-d tree.
/// A cloud without any reading has no outliers. Errors: settings out of range; not more than K
/// points with a reading; arrays that do not fit width x height.
[[nodiscard]] Result<Outliers> find_outliers(const Cloud& cloud, const OutlierSettings& settings);

/// Makes NaN of what is marked.
void clear_points(Cloud& cloud, const std::vector<std::uint8_t>& mask);

}  // namespace kinectlab
