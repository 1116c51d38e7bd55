#pragma once

#include <optional>

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/path_fit.hpp"

namespace kinectlab {

/// What the air does to a ball.
struct Air {
    double drag = 0.0;    ///< 1/m
    double drag_u = 0.0;  ///< 0: exactly
    std::optional<double> density_ratio;
    bool drag_given = false;
};

/// Adds g, the speed and direction at the fit's beginning, the drag and the highest point, with
/// their budgets, as far as the flight shows them; notes tell what is missing. `duration_s` is that
/// of the flight from there; `from_release`: it begins at the release, which is known to
/// conditions.released_u_s.
void measure_projectile(
    AnalysisOutcome& out,
    const PathFit& fit,
    const Air& air,
    double duration_s,
    bool from_release,
    const AnalysisConditions& conditions
);

}  // namespace kinectlab
