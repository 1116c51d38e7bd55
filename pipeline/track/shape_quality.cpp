#include "pipeline/track/shape_quality.hpp"

#include <cmath>

namespace kinectlab {

ShapeQuality judge_fit(const ShapePixels& pixels, double gate_steps) {
    const auto gate = static_cast<float>(gate_steps);
    std::size_t inliers = 0, kept = 0;
    double squares = 0.0, loss = 0.0;
    for (std::size_t i = 0; i < pixels.offered; ++i) {
        const float off = std::abs(pixels.residual[i]);  // NaN where the ray does not meet it
        if (!(off <= gate)) {
            loss += 1.0;
            continue;
        }
        const double t = 1.0 - off * off / (gate * gate);
        loss += 1.0 - t * t * t;
        ++inliers;
        if (pixels.weight[i] <= 0.0F) continue;
        ++kept;
        squares += off * off;
    }
    const auto all = static_cast<double>(pixels.offered);
    ShapeQuality found;
    found.quality.points = static_cast<int>(inliers);
    found.quality.inlier_share = static_cast<double>(inliers) / all;
    found.quality.rms_steps = kept > 0 ? std::sqrt(squares / static_cast<double>(kept)) : 0.0;
    found.cost = loss / all;
    return found;
}

}  // namespace kinectlab
