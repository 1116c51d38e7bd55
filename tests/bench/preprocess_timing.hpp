#pragma once

#include <algorithm>
#include <limits>

#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {

/// Least time of this thread that `work` took in `rounds` rounds, ms: what others do to the caches
/// of a shared machine is not the method's.
template <class Work>
double least_ms(int rounds, Work&& work) {
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0; round < rounds; ++round) {
        const double start = thread_seconds();
        work();
        least = std::min(least, 1e3 * (thread_seconds() - start));
    }
    return least;
}

}  // namespace kinectlab::bench
