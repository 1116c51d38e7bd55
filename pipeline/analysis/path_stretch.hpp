#pragma once

#include <functional>
#include <span>
#include <vector>

#include "pipeline/analysis/position_samples.hpp"

namespace kinectlab {

/// The samples [begin, end).
struct Stretch {
    std::size_t begin = 0;
    std::size_t end = 0;

    [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// One stretch with its parabola: p(t) = p + v (t - t0) + a (t - t0)²/2, t0 at its first sample.
struct ParabolaStretch {
    Stretch samples;
    Eigen::Vector3d p;    ///< m
    Eigen::Vector3d v;    ///< m/s
    Eigen::Vector3d a;    ///< m/s²
    Eigen::Vector3d u_a;  ///< m/s², taking the noise as lasting for some frames
};

/// By how much the positions' scatter from one to the next exceeds what they say of themselves: 1
/// or more. Slow noise is not seen in it.
[[nodiscard]] double noise_excess(std::span<const PositionSample> samples);

/// Cuts a recording where its motion changes its law: held, pushed, free, bounced, at rest, each a
/// parabola. The cuts are those of least cost, the sum of squares plus a price for each stretch
/// (Jackson et al., IEEE Signal Process. Lett. 12 (2005)). Single wild samples do not cut. A
/// stretch has 500 samples at most.
[[nodiscard]] std::vector<ParabolaStretch> parabola_stretches(
    std::span<const PositionSample> samples
);

/// Predicted positions, m, at times of samples, from a fit to the samples of a stretch; empty if
/// there is no such fit.
using StretchPath = std::function<
    std::vector<Eigen::Vector3d>(const Stretch& fitted, std::span<const PositionSample> at)>;

/// Lets a stretch grow to both sides for as long as blocks of samples follow what the fit to it
/// predicts, fitting anew after each quarter that it grew. `block`: samples that are judged
/// together; `bad_blocks`: how many in a row may be off before it ends.
[[nodiscard]] Stretch grow_stretch(
    std::span<const PositionSample> samples,
    Stretch known,
    const StretchPath& path,
    std::size_t block,
    int bad_blocks = 1
);

/// Without a share of it (at least `fewest` samples, half the block by which it grew) at each end
/// that is not the recording's: there it may still be under another law too weakly to be seen.
[[nodiscard]] Stretch without_ends(
    std::span<const PositionSample> samples,
    const Stretch& stretch,
    double share,
    std::size_t fewest
);

}  // namespace kinectlab
