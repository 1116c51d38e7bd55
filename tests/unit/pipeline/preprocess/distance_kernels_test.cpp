#include "pipeline/preprocess/distance_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kinectlab {
namespace {

/// Values with many ties, and room for padding behind them.
std::vector<float> some_values(std::size_t n) {
    std::vector<float> values;
    for (std::size_t i = 0; i < n; ++i)
        values.push_back(static_cast<float>(*rc::gen::inRange(0, 40)) * 0.37F);
    values.resize(n + 8);
    return values;
}

RC_GTEST_PROP(DistanceKernels, SumsTheSmallestRoots, ()) {
    const int n = *rc::gen::inRange(1, 300);
    const int k = *rc::gen::inRange(1, n + 1);
    const std::vector<float> values = some_values(static_cast<std::size_t>(n));
    std::vector<float> sorted(values.begin(), values.begin() + n);
    std::sort(sorted.begin(), sorted.end());
    double expected = 0.0;
    for (int i = 0; i < k; ++i)
        expected += static_cast<double>(std::sqrt(sorted[static_cast<std::size_t>(i)]));
    for (const auto* kernels : {&distance_kernels(), &portable_distance_kernels()}) {
        for (const float limit : {sorted.back() + 1.0F, HUGE_VALF}) {
            std::vector<float> copy = values;
            const Rank rank = rank_of(*kernels, copy.data(), n, k, limit);
            RC_ASSERT(rank.below <= k);
            const double sum = sum_of_smallest_roots(*kernels, copy.data(), n, k, rank);
            RC_ASSERT(std::abs(sum - expected) < 1e-9 * (1.0 + expected));
        }
    }
}

RC_GTEST_PROP(DistanceKernels, CollectsWhatLiesWithin, ()) {
    const int columns = *rc::gen::inRange(1, 40);
    const int rows = *rc::gen::inRange(1, 6);
    const int stride = columns + 8;
    const auto room = static_cast<std::size_t>(stride * rows + 8);
    std::vector<float> x(room, std::nanf("")), y = x, z = x;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const auto i = static_cast<std::size_t>(row * stride + column);
            if (*rc::gen::inRange(0, 10) == 0) continue;
            x[i] = static_cast<float>(*rc::gen::inRange(0, 20));
            y[i] = static_cast<float>(*rc::gen::inRange(0, 20));
            z[i] = static_cast<float>(*rc::gen::inRange(0, 20));
        }
    std::vector<std::vector<float>> found;
    for (const auto* kernels : {&distance_kernels(), &portable_distance_kernels()}) {
        std::vector<float> out(room + 8);
        const PointRows points{x.data(), y.data(), z.data(), stride, rows, columns};
        const int n = kernels->collect(points, {5, 6, 7}, 90.0F, out.data());
        out.resize(static_cast<std::size_t>(n));
        found.push_back(out);
    }
    std::vector<float> expected;
    for (std::size_t i = 0; i < room; ++i) {
        const float dx = x[i] - 5, dy = y[i] - 6, dz = z[i] - 7;
        if (const float squared = dx * dx + dy * dy + dz * dz; squared < 90.0F)
            expected.push_back(squared);
    }
    RC_ASSERT(found[0] == expected);
    RC_ASSERT(found[1] == expected);
}

}  // namespace
}  // namespace kinectlab
