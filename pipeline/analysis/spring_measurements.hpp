#pragma once

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/path_fit.hpp"

namespace kinectlab {

/// 1/m: how large the quadratic drag may be of what hangs on a spring in air.
constexpr double kSpringQuadraticUnknown = 0.1;

/// What the fit of spring_path knows, with budgets, and notes of what it does not. `length`: 1 in
/// metres, else the motion's extent, for what was assumed in metres.
void spring_measurements(
    AnalysisOutcome& out,
    const PathFit& fit,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions,
    double length
);

}  // namespace kinectlab
