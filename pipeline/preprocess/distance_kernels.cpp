#include "pipeline/preprocess/distance_kernels.hpp"

#include <bit>
#include <cstdint>

#include "pipeline/preprocess/packed_lanes.hpp"
#include "pipeline/preprocess/sum_smallest.hpp"

namespace kinectlab {
namespace {

int collect_portable(const PointStrips& points, Point3 from, float limit, float* out) {
    int found = 0;
    for (const Strip& strip : points.strips) {
        std::ptrdiff_t start = strip.start;
        for (int row = 0; row < strip.rows; ++row, start += points.stride) {
            for (int i = 0; i < 8; ++i) {
                const float dx = points.x[start + i] - from.x;
                const float dy = points.y[start + i] - from.y;
                const float dz = points.z[start + i] - from.z;
                const float squared = dx * dx + dy * dy + dz * dz;
                out[found] = squared;
                found += squared < limit ? 1 : 0;
            }
        }
    }
    return found;
}

constexpr DistanceKernels kPortable{collect_portable, sum_smallest_portable};

#ifdef KINECTLAB_HAS_AVX2

KINECTLAB_AVX2 int collect_avx2(const PointStrips& points, Point3 from, float limit, float* out) {
    const __m256 x0 = _mm256_set1_ps(from.x);
    const __m256 y0 = _mm256_set1_ps(from.y);
    const __m256 z0 = _mm256_set1_ps(from.z);
    const __m256 most = _mm256_set1_ps(limit);
    const std::ptrdiff_t stride = points.stride;
    float* end = out;
    for (const Strip& strip : points.strips) {
        const float* x = points.x + strip.start;
        const float* y = points.y + strip.start;
        const float* z = points.z + strip.start;
        for (int rows = strip.rows; rows > 0; --rows, x += stride, y += stride, z += stride) {
            const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(x), x0);
            const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(y), y0);
            const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(z), z0);
            const __m256 squared = _mm256_add_ps(
                _mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz)
            );
            const auto set = static_cast<std::uint32_t>(
                _mm256_movemask_ps(_mm256_cmp_ps(squared, most, _CMP_LT_OQ))
            );
            _mm256_storeu_ps(end, packed(squared, set));
            end += std::popcount(set);
        }
    }
    return static_cast<int>(end - out);
}

constexpr DistanceKernels kAvx2{collect_avx2, sum_smallest_avx2};

#endif

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

}  // namespace kinectlab
