#pragma once

#include <array>
#include <cstdint>

/// For .cpp files that have a loop in AVX2 beside the portable one.
#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define KINECTLAB_HAS_AVX2 1
#define KINECTLAB_AVX2 __attribute__((target("avx2")))

namespace kinectlab {

/// For every set of eight lanes the order that brings the set's members to the front, a byte each:
/// the table must leave room for the points in the cache.
inline constexpr auto kPacking = [] {
    std::array<std::uint64_t, 256> table{};
    for (std::uint32_t set = 0; set < 256; ++set) {
        std::uint32_t packed = 0;
        for (std::uint64_t lane = 0; lane < 8; ++lane)
            if ((set >> lane & 1U) != 0) table[set] |= lane << (8 * packed++);
    }
    return table;
}();

/// The values of a set of lanes, brought to the front.
KINECTLAB_AVX2 inline __m256 packed(__m256 values, std::uint32_t set) {
    const auto order = static_cast<long long>(kPacking[set]);
    return _mm256_permutevar8x32_ps(values, _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(order)));
}

}  // namespace kinectlab

#endif
