#pragma once

#include <span>

#include "pipeline/analysis/position_samples.hpp"

namespace kinectlab {

/// Of the path seen from the side, z = a + b u + value u² along the horizontal direction u of most
/// motion: a small swing's arc has 1/(2 R).
struct ArcCurvature {
    double value = 0.0;  ///< 1/m, above zero if the ends are higher than the middle
    double u = 0.0;      ///< as if the noise were white

    [[nodiscard]] bool shows() const { return value > 5.0 * u; }
    [[nodiscard]] bool shows_upside_down() const { return value < -5.0 * u; }
};

/// By least squares with wild samples weighted down; at least 30 samples.
[[nodiscard]] ArcCurvature arc_curvature(std::span<const PositionSample> samples);

/// Whether all samples lie in one plane y = constant exactly, as two-dimensional tables do: nothing
/// is then known across it.
[[nodiscard]] bool is_flat(std::span<const PositionSample> samples);

}  // namespace kinectlab
