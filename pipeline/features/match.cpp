#include "pipeline/features/match.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kLanes = 16;
constexpr std::size_t kBlock = 64;
constexpr float kFar = std::numeric_limits<float>::max();

KINECTLAB_HOT_LOOP void least_of_lanes(
    const float* __restrict distances, std::size_t blocks, float* __restrict least
) {
    for (std::size_t block = 0; block < blocks; ++block)
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const float here = distances[block * kLanes + lane];
            least[lane] = here < least[lane] ? here : least[lane];
        }
}

KINECTLAB_HOT_LOOP bool any_below(const float* __restrict distances, float limit) {
    int below = 0;
    for (std::size_t i = 0; i < kBlock; ++i)
        below |= static_cast<int>(distances[i] < limit);
    return below != 0;
}

}  // namespace

float least_of(const float* distances, std::size_t count) {
    std::array<float, kLanes> lanes{};
    lanes.fill(kFar);
    const std::size_t blocks = count / kLanes;
    least_of_lanes(distances, blocks, lanes.data());
    float least = *std::min_element(lanes.begin(), lanes.end());
    for (std::size_t i = blocks * kLanes; i < count; ++i)
        least = std::min(least, distances[i]);
    return least;
}

std::size_t next_below(const float* distances, std::size_t from, std::size_t count, float limit) {
    std::size_t at = from;
    while (at + kBlock <= count && !any_below(distances + at, limit))
        at += kBlock;
    while (at < count && !(distances[at] < limit))
        ++at;
    return at;
}

}  // namespace kinectlab
