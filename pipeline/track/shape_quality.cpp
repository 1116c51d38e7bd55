#include "pipeline/track/shape_quality.hpp"

#include <cmath>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/vector8.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

KINECTLAB_INLINE double total(const Float8& value) {
    double sum = 0.0;
    for (int lane = 0; lane < 8; ++lane)
        sum += value[lane];
    return sum;
}

struct InlierSums {
    double inliers = 0.0, kept = 0.0;
    double squares = 0.0;  // of those kept
    double gain = 0.0;     // 1 less Tukey's loss
};

/// Counts are exact: single precision holds whole numbers up to 16 million. A residual is NaN where
/// the ray does not meet the shape; the padding has readings of 0.
KINECTLAB_HOT_LOOP void sum_inliers(
    const float* residual,
    const float* weight,
    const float* reading,
    std::size_t size,
    float gate,
    InlierSums& sums
) {
    Float8 inliers{}, kept{}, squares{}, gain{};
    const Float8 one = all8(1.0F);
    const float per_gate2 = 1.0F / (gate * gate);
    for (std::size_t i = 0; i < size; i += kFitLanes) {
        const Float8 r = load8(residual + i);
        const Mask8 in = (abs8(r) <= gate) & (load8(reading + i) > 0.0F);
        const Mask8 counts = in & (load8(weight + i) > 0.0F);
        const Float8 t = 1.0F - r * r * per_gate2;
        inliers += keep8(one, in);
        gain += keep8(t * t * t, in);
        kept += keep8(one, counts);
        squares += keep8(r * r, counts);
    }
    sums = {total(inliers), total(kept), total(squares), total(gain)};
}

KINECTLAB_HOT_LOOP void add_rim(
    const float* residual,
    const float* used,
    const float* before,
    std::size_t size,
    float gate,
    RimSums& sums
) {
    Float8 count{}, squares{};
    for (std::size_t i = 0; i < size; i += kFitLanes) {
        const Mask8 rim = (load8(used + i) > 0.0F) & (load8(before + i) == 0.0F);
        const Float8 r = load8(residual + i);
        const Float8 square = choose8(abs8(r) < gate, r * r, all8(gate * gate));
        count += keep8(all8(1.0F), rim);
        squares += keep8(square, rim);
    }
    sums = {total(count), total(squares)};
}

}  // namespace

ShapeQuality judge_fit(const ShapePixels& pixels, double gate_steps) {
    InlierSums sums;
    sum_inliers(
        pixels.residual.data(),
        pixels.weight.data(),
        pixels.s.data(),
        pixels.s.size(),
        static_cast<float>(gate_steps),
        sums
    );
    const auto all = static_cast<double>(pixels.offered);
    ShapeQuality found;
    found.quality.points = static_cast<int>(sums.inliers);
    found.quality.inlier_share = sums.inliers / all;
    found.quality.rms_steps = sums.kept > 0.0 ? std::sqrt(sums.squares / sums.kept) : 0.0;
    found.cost = 1.0 - sums.gain / all;
    return found;
}

RimSums sum_rim(const ShapePixels& pixels, double gate_steps) {
    RimSums sums;
    add_rim(
        pixels.residual.data(),
        pixels.used.data(),
        pixels.chosen_before.data(),
        pixels.s.size(),
        static_cast<float>(gate_steps),
        sums
    );
    return sums;
}

}  // namespace kinectlab
