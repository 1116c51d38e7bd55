#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "pipeline/core/cloud.hpp"

namespace kinectlab::bench {

/// What a method returned, and the time of this thread that it took, without conversions.
template <class T>
struct Timed {
    T value;
    double ms = 0.0;
};

/// A cloud as the Point Cloud Library holds it.
class StockCloud {
public:
    explicit StockCloud(const Cloud& cloud);
    ~StockCloud();
    StockCloud(const StockCloud&) = delete;
    StockCloud& operator=(const StockCloud&) = delete;
    struct State;
    [[nodiscard]] const State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

using Mask = std::vector<std::uint8_t>;

/// 1 = kept: z within [0.1, limit].
[[nodiscard]] Timed<Mask> stock_pass_through(const StockCloud& cloud, double limit_m);

/// 1 = outlier.
[[nodiscard]] Timed<Mask> stock_outliers(const StockCloud& cloud, int neighbours, double factor);

/// The moved point of each pixel; NaN where there is none.
[[nodiscard]] Timed<std::vector<Eigen::Vector3f>> stock_smoothed(
    const StockCloud& cloud, double radius_m, int order
);

enum class StockNormals { covariance, gradient, depth_change };

/// Integral images, smoothed over `size_px`.
[[nodiscard]] Timed<std::vector<Eigen::Vector3f>> stock_normals(
    const StockCloud& cloud, StockNormals method, double size_px
);

/// 1 = in a voxel that was empty. The time is that of the new frame: its points go into the octree
/// whose other buffer holds the reference, and the new voxels are asked for.
[[nodiscard]] Timed<Mask> stock_octree_change(
    const StockCloud& reference, const StockCloud& cloud, double voxel_m, int least_points
);

}  // namespace kinectlab::bench
