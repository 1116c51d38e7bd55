#pragma once

#include "pipeline/preprocess/distance_kernels.hpp"

namespace kinectlab {

/// DistanceKernels::sum_smallest, both ways.
[[nodiscard]] SumOfRoots sum_smallest_portable(float* values, int size, int k, float limit);
[[nodiscard]] SumOfRoots sum_smallest_avx2(float* values, int size, int k, float limit);

}  // namespace kinectlab
