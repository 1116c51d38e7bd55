#pragma once

namespace kinectlab {

struct Point3 {
    float x, y, z;
};

/// Rows of coordinates, each padded with NaN to where eight more can be read.
struct PointRows {
    const float* x;
    const float* y;
    const float* z;
    int stride;  ///< from one row to the next
    int rows;
    int columns;  ///< read in eights: up to seven more are taken in
};

/// The inner loops of neighbour search, once for every x86-64 and once with AVX2. All squared
/// distances are (dx² + dy²) + dz² in float, without fused operations, as PCL has them.
struct DistanceKernels {
    /// Appends the squared distances below `limit` to `out`, which has room for all points and
    /// eight more; returns how many.
    int (*collect)(const PointRows& points, Point3 from, float limit, float* out);
    /// How many of `values` are at most `limit`; `values` are padded with NaN to eights.
    int (*count)(const float* values, int size, float limit);
    /// Sum of the roots of those that are at most `limit`, each rounded to float.
    double (*sum_roots)(const float* values, int size, float limit);
};

/// The fastest that this machine has.
[[nodiscard]] const DistanceKernels& distance_kernels();
[[nodiscard]] const DistanceKernels& portable_distance_kernels();

/// Where the `k` smallest of some values end: `below` of them are at most `limit` if that is k;
/// otherwise several are equal to `limit`, the k-th smallest, and `below` are smaller.
struct Rank {
    float limit;
    int below;
};

/// Of `size` values (at least k) from 0 up to and without `limit`. Writes padding behind them: room
/// for eight more.
[[nodiscard]] Rank rank_of(
    const DistanceKernels& kernels, float* values, int size, int k, float limit
);

/// Sum of the roots of the `k` smallest, whose rank this is; the padding is there already.
[[nodiscard]] double sum_of_smallest_roots(
    const DistanceKernels& kernels, const float* values, int size, int k, Rank rank
);

}  // namespace kinectlab
