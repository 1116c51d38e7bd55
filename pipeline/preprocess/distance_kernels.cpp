#include "pipeline/preprocess/distance_kernels.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define KINECTLAB_HAS_AVX2 1
#endif

namespace kinectlab {
namespace {

int collect_portable(const PointRows& points, Point3 from, float limit, float* out) {
    const int columns = (points.columns + 7) / 8 * 8;
    int found = 0;
    for (int row = 0; row < points.rows; ++row) {
        const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(row) * points.stride;
        for (int i = 0; i < columns; ++i) {
            const float dx = points.x[start + i] - from.x;
            const float dy = points.y[start + i] - from.y;
            const float dz = points.z[start + i] - from.z;
            const float squared = dx * dx + dy * dy + dz * dz;
            out[found] = squared;
            found += squared < limit ? 1 : 0;
        }
    }
    return found;
}

int count_portable(const float* values, int size, float limit) {
    int count = 0;
    for (int i = 0; i < size; ++i)
        count += values[i] <= limit ? 1 : 0;
    return count;
}

double sum_roots_portable(const float* values, int size, float limit) {
    double sum = 0.0;
    for (int i = 0; i < size; ++i)
        sum += values[i] <= limit ? static_cast<double>(std::sqrt(values[i])) : 0.0;
    return sum;
}

constexpr DistanceKernels kPortable{collect_portable, count_portable, sum_roots_portable};

#ifdef KINECTLAB_HAS_AVX2

/// For every set of eight lanes the order that brings the set's members to the front.
constexpr auto kPacking = [] {
    std::array<std::array<std::uint32_t, 8>, 256> table{};
    for (std::uint32_t set = 0; set < 256; ++set) {
        std::uint32_t packed = 0;
        for (std::uint32_t lane = 0; lane < 8; ++lane)
            if ((set >> lane & 1U) != 0) table[set][packed++] = lane;
    }
    return table;
}();

__attribute__((target("avx2"))) int collect_avx2(
    const PointRows& points, Point3 from, float limit, float* out
) {
    const __m256 x0 = _mm256_set1_ps(from.x);
    const __m256 y0 = _mm256_set1_ps(from.y);
    const __m256 z0 = _mm256_set1_ps(from.z);
    const __m256 most = _mm256_set1_ps(limit);
    const int rows = points.rows;
    const int columns = points.columns;
    float* end = out;
    for (int row = 0; row < rows; ++row) {
        const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(row) * points.stride;
        for (int i = 0; i < columns; i += 8) {
            const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(points.x + start + i), x0);
            const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(points.y + start + i), y0);
            const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(points.z + start + i), z0);
            const __m256 squared = _mm256_add_ps(
                _mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz)
            );
            const auto set = static_cast<std::uint32_t>(
                _mm256_movemask_ps(_mm256_cmp_ps(squared, most, _CMP_LT_OQ))
            );
            const __m256i order =
                _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kPacking[set].data()));
            _mm256_storeu_ps(end, _mm256_permutevar8x32_ps(squared, order));
            end += std::popcount(set);
        }
    }
    return static_cast<int>(end - out);
}

__attribute__((target("avx2"))) int count_avx2(const float* values, int size, float limit) {
    const __m256 most = _mm256_set1_ps(limit);
    __m256i counts = _mm256_setzero_si256();
    for (int i = 0; i < size; i += 8) {
        const __m256 within = _mm256_cmp_ps(_mm256_loadu_ps(values + i), most, _CMP_LE_OQ);
        counts = _mm256_sub_epi32(counts, _mm256_castps_si256(within));
    }
    __m128i half =
        _mm_add_epi32(_mm256_castsi256_si128(counts), _mm256_extracti128_si256(counts, 1));
    half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0x4E));
    half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0xB1));
    return _mm_cvtsi128_si32(half);
}

__attribute__((target("avx2"))) double sum_roots_avx2(const float* values, int size, float limit) {
    const __m256 most = _mm256_set1_ps(limit);
    __m256d low = _mm256_setzero_pd();
    __m256d high = _mm256_setzero_pd();
    for (int i = 0; i < size; i += 8) {
        const __m256 value = _mm256_loadu_ps(values + i);
        const __m256 within = _mm256_cmp_ps(value, most, _CMP_LE_OQ);
        const __m256 root = _mm256_sqrt_ps(_mm256_and_ps(value, within));
        low = _mm256_add_pd(low, _mm256_cvtps_pd(_mm256_castps256_ps128(root)));
        high = _mm256_add_pd(high, _mm256_cvtps_pd(_mm256_extractf128_ps(root, 1)));
    }
    const __m256d sum = _mm256_add_pd(low, high);
    const __m128d half = _mm_add_pd(_mm256_castpd256_pd128(sum), _mm256_extractf128_pd(sum, 1));
    return _mm_cvtsd_f64(_mm_add_sd(half, _mm_unpackhi_pd(half, half)));
}

constexpr DistanceKernels kAvx2{collect_avx2, count_avx2, sum_roots_avx2};

#endif

float middle_of(float low, float high) {
    return std::bit_cast<float>(
        (std::bit_cast<std::uint32_t>(low) + std::bit_cast<std::uint32_t>(high)) / 2
    );
}

}  // namespace

const DistanceKernels& portable_distance_kernels() {
    return kPortable;
}

const DistanceKernels& distance_kernels() {
#ifdef KINECTLAB_HAS_AVX2
    static const bool avx2 = __builtin_cpu_supports("avx2") != 0;
    if (avx2) return kAvx2;
#endif
    return kPortable;
}

Rank rank_of(const DistanceKernels& kernels, float* values, int size, int k, float limit) {
    for (int i = 0; i < 8; ++i)
        values[size + i] = std::numeric_limits<float>::quiet_NaN();
    if (size == k) return {limit, k};
    float low = 0.0F;
    float high = limit;
    int at_low = kernels.count(values, size, low);
    if (at_low >= k) return {0.0F, 0};
    int at_high = size;
    // On a surface the count grows with the squared distance, so the secant is nearly there.
    constexpr int kSecants = 8;
    for (int step = 0;; ++step) {
        float guess = low + (high - low) * (static_cast<float>(k - at_low) + 0.5F) /
                                (static_cast<float>(at_high - at_low) + 1.0F);
        if (step >= kSecants || !(guess > low && guess < high)) guess = middle_of(low, high);
        if (guess == low) return {high, at_low};  // neighbours among floats: several are equal
        const int at_guess = kernels.count(values, size, guess);
        if (at_guess == k) return {guess, k};
        (at_guess < k ? low : high) = guess;
        (at_guess < k ? at_low : at_high) = at_guess;
    }
}

double sum_of_smallest_roots(
    const DistanceKernels& kernels, const float* values, int size, int k, Rank rank
) {
    if (rank.below == k) return kernels.sum_roots(values, size, rank.limit);
    const float under = std::nextafter(rank.limit, -1.0F);
    const double rest = k - rank.below;
    return (rank.below == 0 ? 0.0 : kernels.sum_roots(values, size, under)) +
           rest * static_cast<double>(std::sqrt(rank.limit));
}

}  // namespace kinectlab
