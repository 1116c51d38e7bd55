#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinectlab {

struct Point3 {
    float x, y, z;
};

/// Eight columns of coordinates from `start` on, down `rows` rows.
struct Strip {
    std::ptrdiff_t start;
    int rows;
};

/// Strips of points, padded with NaN where nothing lies.
struct PointStrips {
    const float* x;
    const float* y;
    const float* z;
    std::ptrdiff_t stride;  ///< from one row to the next
    std::span<const Strip> strips;
};

struct SumOfRoots {
    double sum;
    float last;  ///< the greatest value in it
};

/// The inner loops of neighbour search, once for every x86-64 and once with AVX2. All squared
/// distances are (dx² + dy²) + dz² in float, without fused operations, as PCL has them.
struct DistanceKernels {
    /// Appends the squared distances below `limit` to `out`, which has room for all points and
    /// eight more; returns how many.
    int (*collect)(const PointStrips& points, Point3 from, float limit, float* out);
    /// Adds up the roots, each rounded to float, of the `k` smallest of `size` values (at least k)
    /// from 0 up to `limit`. May change the values, and kPadding more behind them.
    SumOfRoots (*sum_smallest)(float* values, int size, int k, float limit);

    static constexpr int kPadding = 32;
};

/// The fastest that this machine has.
[[nodiscard]] const DistanceKernels& distance_kernels();
[[nodiscard]] const DistanceKernels& portable_distance_kernels();

}  // namespace kinectlab
