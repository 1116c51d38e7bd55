#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kinectlab {

/// Descriptor `model` is that of `scene`, and nothing else in the scene is nearly as similar.
struct Match {
    std::uint32_t model = 0;
    std::uint32_t scene = 0;
    float distance = 0.0F;
};

/// For each model descriptor the nearest in the scene, if the second nearest is farther by the
/// ratio (Lowe 2004, 7.1). `distance(m, s)` ≥ 0; `same(s, t)` tells whether two of the scene are
/// the same spot, which then do not stand against each other. Each scene descriptor goes to the
/// model descriptor that is nearest to it.
template <class Distances, class Same>
void match_nearest(
    std::size_t models,
    std::size_t scenes,
    float ratio,
    Distances&& fill,
    Same&& same,
    std::vector<Match>& matches
) {
    constexpr float kFar = std::numeric_limits<float>::max();
    matches.clear();
    std::vector<std::uint32_t> taken(scenes, 0);  // place in matches, from 1
    std::vector<float> distances(scenes);
    for (std::uint32_t m = 0; m < models; ++m) {
        float best = kFar;
        std::uint32_t at = 0;
        fill(m, distances.data());
        for (std::uint32_t s = 0; s < scenes; ++s)
            if (distances[s] < best) best = distances[s], at = s;
        if (best == kFar) continue;
        float second = kFar;
        for (std::uint32_t s = 0; s < scenes; ++s)
            if (distances[s] < second && s != at && !same(s, at)) second = distances[s];
        if (best > ratio * second) continue;
        if (taken[at] == 0) {
            matches.push_back({m, at, best});
            taken[at] = static_cast<std::uint32_t>(matches.size());
        } else if (best < matches[taken[at] - 1].distance) {
            matches[taken[at] - 1] = {m, at, best};
        }
    }
}

}  // namespace kinectlab
