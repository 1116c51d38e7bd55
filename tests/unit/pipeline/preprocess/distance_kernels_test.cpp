#include "pipeline/preprocess/distance_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kinectlab {
namespace {

constexpr auto kRoom = static_cast<std::size_t>(DistanceKernels::kPadding);

/// Values that are all different, that often are the same, or that differ in their last bits only.
std::vector<float> some_values(std::size_t n, int kind) {
    std::vector<float> values;
    for (std::size_t i = 0; i < n; ++i) {
        const auto whole = static_cast<float>(*rc::gen::inRange(0, kind == 0 ? 1'000'000 : 40));
        values.push_back(kind == 2 ? 1.0F + whole * 1.2e-7F : whole * 0.37F);
    }
    values.resize(n + kRoom);
    return values;
}

void expect_smallest(const std::vector<float>& values, int n, int k, float limit) {
    std::vector<float> sorted(values.begin(), values.begin() + n);
    std::sort(sorted.begin(), sorted.end());
    double expected = 0.0;
    for (int i = 0; i < k; ++i)
        expected += static_cast<double>(std::sqrt(sorted[static_cast<std::size_t>(i)]));
    for (const auto* kernels : {&distance_kernels(), &portable_distance_kernels()}) {
        std::vector<float> copy = values;
        const SumOfRoots found = kernels->sum_smallest(copy.data(), n, k, limit);
        RC_ASSERT(static_cast<float>(found.sum / k) == static_cast<float>(expected / k));
        RC_ASSERT(found.last >= sorted[static_cast<std::size_t>(k - 1)]);
        RC_ASSERT(found.last <= limit);
        if (k < n) RC_ASSERT(found.last <= sorted[static_cast<std::size_t>(k)]);
    }
}

RC_GTEST_PROP(DistanceKernels, SumsTheSmallestRoots, ()) {
    const int n = *rc::gen::inRange(1, 300);
    const int k = *rc::gen::inRange(1, n + 1);
    const auto values = some_values(static_cast<std::size_t>(n), *rc::gen::inRange(0, 3));
    const float most = *std::max_element(values.begin(), values.begin() + n);
    for (const float limit : {std::nextafter(most, HUGE_VALF), most + 1.0F, 1e6F, HUGE_VALF})
        expect_smallest(values, n, k, limit);
}

RC_GTEST_PROP(DistanceKernels, SumsTheSmallestRootsOfVeryUnequalValues, ()) {
    const int n = *rc::gen::inRange(1, 300);
    const int k = *rc::gen::inRange(1, n + 1);
    std::vector<float> values;
    for (int i = 0; i < n; ++i)
        values.push_back(std::ldexp(1.0F, *rc::gen::inRange(-30, 8)));
    if (*rc::gen::inRange(0, 2) == 0) std::fill_n(values.begin(), n / 2, 0.0F);
    values.resize(values.size() + kRoom);
    for (const float limit : {256.0F, 1e30F, HUGE_VALF})
        expect_smallest(values, n, k, limit);
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
        std::vector<Strip> strips;
        for (int column = 0; column < columns; column += 8)
            strips.push_back({column, rows});
        const PointStrips points{x.data(), y.data(), z.data(), stride, strips};
        const int n = kernels->collect(points, {5, 6, 7}, 90.0F, out.data());
        out.resize(static_cast<std::size_t>(n));
        std::sort(out.begin(), out.end());
        found.push_back(out);
    }
    std::vector<float> expected;
    for (std::size_t i = 0; i < room; ++i) {
        const float dx = x[i] - 5, dy = y[i] - 6, dz = z[i] - 7;
        if (const float squared = dx * dx + dy * dy + dz * dz; squared < 90.0F)
            expected.push_back(squared);
    }
    std::sort(expected.begin(), expected.end());
    RC_ASSERT(found[0] == expected);
    RC_ASSERT(found[1] == expected);
}

}  // namespace
}  // namespace kinectlab
