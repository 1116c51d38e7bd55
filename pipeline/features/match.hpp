#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinectlab {

/// Descriptor `model` is that of `scene`, and nothing else in the scene is nearly as similar.
struct Match {
    std::uint32_t model = 0;
    std::uint32_t scene = 0;
    float distance = 0.0F;
};

/// The least of some distances; the largest float of none.
[[nodiscard]] float least_of(const float* distances, std::size_t count);

/// Where the next distance below a limit is, `count` if there is none from `from` on.
[[nodiscard]] std::size_t next_below(
    const float* distances, std::size_t from, std::size_t count, float limit
);

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
    matches.clear();
    std::vector<std::uint32_t> taken(scenes, 0);  // place in matches, from 1
    std::vector<float> distances(scenes);
    for (std::uint32_t m = 0; m < models && scenes > 0; ++m) {
        fill(m, distances.data());
        const float* all = distances.data();
        const float best = least_of(all, scenes);
        std::size_t at = 0;
        while (all[at] != best && ++at < scenes) {
        }
        if (at == scenes) continue;  // none is a number
        const float second = best / ratio;
        std::size_t rival = next_below(all, 0, scenes, second);
        while (rival < scenes && (rival == at || same(rival, at)))
            rival = next_below(all, rival + 1, scenes, second);
        if (rival < scenes) continue;
        if (taken[at] == 0) {
            matches.push_back({m, static_cast<std::uint32_t>(at), best});
            taken[at] = static_cast<std::uint32_t>(matches.size());
        } else if (best < matches[taken[at] - 1].distance) {
            matches[taken[at] - 1] = {m, static_cast<std::uint32_t>(at), best};
        }
    }
}

}  // namespace kinectlab
