#include "pipeline/analysis/free_swing.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kinectlab {
namespace {

constexpr int kBadBlocks = 3;

struct Walk {
    std::size_t good = 0;     // samples that follow the path
    bool ended = false;       // there is no more of it
    bool at_the_end = false;  // because the samples end
};

/// Looks at the samples that `at` names one after the other, `count` of them.
template <class Index>
Walk walk(
    std::span<const PositionSample> samples,
    Index at,
    std::size_t count,
    std::size_t block,
    const SwingParameters& parameters,
    double t0,
    double reach,
    const PathTolerance& tolerance
) {
    SwingPath path(parameters);
    Walk walk;
    int bad = 0;
    std::size_t next = 0;
    while (next < count && bad < kBadBlocks) {
        if (next > 0 && bad == 0 && std::abs(samples[at(next)].t - t0) > reach) return walk;
        const std::size_t stop = std::min(next + block, count);
        std::vector<double> off;
        for (; next < stop; ++next) {
            const PositionSample& sample = samples[at(next)];
            path.go_to(sample.t - t0);
            const Eigen::Vector3d r = sample.p_lab - path.position();
            off.push_back(
                std::min((sample.whiten * r).norm() / tolerance.sigma, r.norm() / tolerance.metres)
            );
        }
        const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
        std::nth_element(off.begin(), middle, off.end());
        bad = *middle < 1.0 ? 0 : bad + 1;
        if (bad == 0) walk.good = next;
    }
    walk.ended = true;
    walk.at_the_end = walk.good == count;
    return walk;
}

}  // namespace

FreeSwing grow_free_swing(
    std::span<const PositionSample> samples,
    FreeSwing known,
    const SwingParameters& parameters,
    double period,
    const PathTolerance& tolerance
) {
    const double t0 = samples[known.begin].t;
    const double span = samples[known.end - 1].t - t0;
    const double step =
        (samples.back().t - samples.front().t) / static_cast<double>(samples.size());
    const auto block =
        std::max<std::size_t>(5, static_cast<std::size_t>(std::lround(period / 4.0 / step)));
    FreeSwing grown = known;
    if (!known.end_found) {
        const auto at = [&](std::size_t k) {
            return known.end + k;
        };
        const Walk w = walk(
            samples, at, samples.size() - known.end, block, parameters, t0, 2.0 * span, tolerance
        );
        grown.end += w.good;
        grown.end_found = w.ended;
        if (w.ended && !w.at_the_end) {
            const double limit = samples[grown.end - 1].t - period / 2.0;
            while (grown.end > known.begin + 1 && samples[grown.end - 1].t > limit)
                --grown.end;
        }
    }
    if (!known.begin_found) {
        const auto at = [&](std::size_t k) {
            return known.begin - 1 - k;
        };
        const Walk w = walk(samples, at, known.begin, block, parameters, t0, span, tolerance);
        grown.begin -= w.good;
        grown.begin_found = w.ended;
        if (w.ended && !w.at_the_end) {
            const double limit = samples[grown.begin].t + period / 2.0;
            while (grown.begin + 1 < grown.end && samples[grown.begin].t < limit)
                ++grown.begin;
        }
    }
    return grown;
}

}  // namespace kinectlab
