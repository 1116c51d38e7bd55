#include "pipeline/preprocess/sum_smallest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "pipeline/preprocess/packed_lanes.hpp"

namespace kinectlab {

SumOfRoots sum_smallest_portable(float* values, int size, int k, float /*limit*/) {
    std::nth_element(values, values + (k - 1), values + size);
    double sum = 0.0;
    for (int i = 0; i < k; ++i)
        sum += static_cast<double>(std::sqrt(values[i]));
    return {sum, values[k - 1]};
}

#ifdef KINECTLAB_HAS_AVX2
namespace {

KINECTLAB_AVX2 inline __m256 at_most(__m256 values, __m256 limit) {
    return _mm256_cmp_ps(values, limit, _CMP_LE_OQ);
}

KINECTLAB_AVX2 inline int sum_of(__m256i counts) {
    __m128i half =
        _mm_add_epi32(_mm256_castsi256_si128(counts), _mm256_extracti128_si256(counts, 1));
    half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0x4E));
    half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0xB1));
    return _mm_cvtsi128_si32(half);
}

KINECTLAB_AVX2 inline __m256d in_double(__m256 values) {
    return _mm256_add_pd(
        _mm256_cvtps_pd(_mm256_castps256_ps128(values)),
        _mm256_cvtps_pd(_mm256_extractf128_ps(values, 1))
    );
}

KINECTLAB_AVX2 inline double sum_of(__m256d sums) {
    const __m128d half = _mm_add_pd(_mm256_castpd256_pd128(sums), _mm256_extractf128_pd(sums, 1));
    return _mm_cvtsd_f64(_mm_add_sd(half, _mm_unpackhi_pd(half, half)));
}

KINECTLAB_AVX2 inline float least_of(__m256 values) {
    __m128 half = _mm_min_ps(_mm256_castps256_ps128(values), _mm256_extractf128_ps(values, 1));
    half = _mm_min_ps(half, _mm_movehl_ps(half, half));
    return _mm_cvtss_f32(_mm_min_ss(half, _mm_shuffle_ps(half, half, 1)));
}

constexpr int kStep = DistanceKernels::kPadding;

KINECTLAB_AVX2 inline void count_within(
    const float* values, int size, float low, float high, int& at_low, int& at_high
) {
    const __m256 lows = _mm256_set1_ps(low);
    const __m256 highs = _mm256_set1_ps(high);
    __m256i to_low = _mm256_setzero_si256();
    __m256i to_high = _mm256_setzero_si256();
    // Steps this long, because the end of a loop that is hard to foretell costs as much as they do.
    for (int i = 0; i < size; i += kStep) {
        for (int lanes = 0; lanes < kStep; lanes += 8) {
            const __m256 value = _mm256_loadu_ps(values + i + lanes);
            to_low = _mm256_sub_epi32(to_low, _mm256_castps_si256(at_most(value, lows)));
            to_high = _mm256_sub_epi32(to_high, _mm256_castps_si256(at_most(value, highs)));
        }
    }
    at_low = sum_of(to_low);
    at_high = sum_of(to_high);
}

/// At most this many values are compared each with each.
constexpr int kFew = 32;
// On a surface the count grows with the squared distance, give or take this many.
constexpr int kGive = 9;
constexpr int kSmall = 512;

/// Two limits between which the k-th smallest lies: `at_low` values are at most `low`, fewer than
/// k, and `at_high` at most `high`. Few lie between them, or all those are equal to `high`.
struct Bracket {
    float low, high;
    int at_low, at_high;
};

KINECTLAB_AVX2 inline Bracket bracket_of(const float* values, int size, int k, float limit) {
    const float each = limit / static_cast<float>(size);
    const float middle = each * (static_cast<float>(k) + 0.5F);
    Bracket all{-1.0F, limit, 0, size};
    Bracket near{
        middle - static_cast<float>(kGive) * each,
        std::min(middle + static_cast<float>(kGive) * each, limit),
        0,
        0};
    count_within(values, size, near.low, near.high, near.at_low, near.at_high);
    if (near.at_low < k) {
        all.low = near.low;
        all.at_low = near.at_low;
    } else {
        all.high = near.low;
        all.at_high = near.at_low;
    }
    if (near.at_high >= k && near.at_low < k) {
        all.high = near.high;
        all.at_high = near.at_high;
    } else if (near.at_high < k) {
        all.low = near.high;
        all.at_low = near.at_high;
    }
    constexpr int kSecants = 8;
    for (int step = 0; all.at_high - all.at_low > kFew; ++step) {
        const auto apart = static_cast<float>(all.at_high - all.at_low);
        float at =
            all.low + (all.high - all.low) * (static_cast<float>(k - all.at_low) + 0.5F) / apart;
        if (step >= kSecants || !(at > all.low && at < all.high)) {
            const auto low = std::bit_cast<std::int32_t>(std::max(all.low, 0.0F));
            const auto high = std::bit_cast<std::int32_t>(all.high);
            at = std::bit_cast<float>(low + (high - low) / 2);
            if (at == all.low) break;  // neighbours among floats
        }
        int within = 0;
        int same = 0;
        count_within(values, size, at, at, within, same);
        (within < k ? all.low : all.high) = at;
        (within < k ? all.at_low : all.at_high) = within;
        if (all.high == 0.0F) break;  // all that are left are 0
    }
    return all;
}

/// The `k` smallest of a few values, padded with infinity to eights.
KINECTLAB_AVX2 inline SumOfRoots sum_few(const float* values, int size, int k) {
    const __m256 infinity = _mm256_set1_ps(std::numeric_limits<float>::infinity());
    const __m256i wanted = _mm256_set1_epi32(k);
    __m256d sums = _mm256_setzero_pd();
    __m256 least = infinity;
    int taken = 0;
    for (int i = 0; i < size; i += 8) {
        const __m256 mine = _mm256_loadu_ps(values + i);
        __m256i not_above = _mm256_setzero_si256();
        for (int j = 0; j < size; j += 8)
            for (int lane = 0; lane < 8; ++lane)
                not_above = _mm256_sub_epi32(
                    not_above,
                    _mm256_castps_si256(at_most(_mm256_broadcast_ss(values + j + lane), mine))
                );
        // Those with fewer than k up to them are taken; the next one fills up, however often.
        const __m256 in = _mm256_castsi256_ps(_mm256_cmpgt_epi32(wanted, not_above));
        sums = _mm256_add_pd(sums, in_double(_mm256_sqrt_ps(_mm256_and_ps(mine, in))));
        least = _mm256_min_ps(least, _mm256_blendv_ps(mine, infinity, in));
        taken += std::popcount(static_cast<std::uint32_t>(_mm256_movemask_ps(in)));
    }
    const float last = least_of(least);
    return {sum_of(sums) + (k - taken) * static_cast<double>(std::sqrt(last)), last};
}

/// Adds up the roots of what is at most `low` and brings what lies above it, up to `high`, to
/// `between`; returns how many those are.
KINECTLAB_AVX2 inline int split(
    const float* values, int size, float low, float high, float* between, double& sum
) {
    const __m256 lows = _mm256_set1_ps(low);
    const __m256 highs = _mm256_set1_ps(high);
    float* end = between;
    __m256d sums = _mm256_setzero_pd();
    for (int i = 0; i < size; i += 8) {
        const __m256 value = _mm256_loadu_ps(values + i);
        const __m256 below = at_most(value, lows);
        sums = _mm256_add_pd(sums, in_double(_mm256_sqrt_ps(_mm256_and_ps(value, below))));
        const __m256 inside = _mm256_andnot_ps(below, at_most(value, highs));
        const auto set = static_cast<std::uint32_t>(_mm256_movemask_ps(inside));
        _mm256_storeu_ps(end, packed(value, set));
        end += std::popcount(set);
    }
    _mm256_storeu_ps(end, _mm256_set1_ps(std::numeric_limits<float>::infinity()));
    sum = sum_of(sums);
    return static_cast<int>(end - between);
}

}  // namespace

KINECTLAB_AVX2 SumOfRoots sum_smallest_avx2(float* values, int size, int k, float limit) {
    const __m256 infinity = _mm256_set1_ps(std::numeric_limits<float>::infinity());
    limit = std::min(limit, std::numeric_limits<float>::max());  // the padding lies above
    for (int lanes = 0; lanes < kStep; lanes += 8)
        _mm256_storeu_ps(values + size + lanes, infinity);
    std::array<float, kSmall + 8> between;
    double sum = 0.0;

    // Where `limit` leaves out most of what is not wanted, few lie above a limit that is guessed.
    if (size <= kSmall && size - k + kGive <= kFew) {
        const float low = limit * static_cast<float>(k - kGive) / static_cast<float>(size);
        const int above = split(values, size, low, limit, between.data(), sum);
        if (size - above < k && above <= kFew) {
            const SumOfRoots rest = sum_few(between.data(), above, k - (size - above));
            return {sum + rest.sum, rest.last};
        }
    }
    const Bracket bracket = bracket_of(values, size, k, limit);
    const int missing = k - bracket.at_low;
    if (bracket.at_high - bracket.at_low > kFew) {  // all of them are equal
        split(values, size, bracket.low, bracket.low, between.data(), sum);
        return {sum + missing * static_cast<double>(std::sqrt(bracket.high)), bracket.high};
    }
    const int few = split(values, size, bracket.low, bracket.high, between.data(), sum);
    const SumOfRoots rest = sum_few(between.data(), few, missing);
    return {sum + rest.sum, rest.last};
}
#endif

}  // namespace kinectlab
