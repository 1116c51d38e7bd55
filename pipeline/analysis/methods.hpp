#pragma once

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab {

// Each in the .cpp of its name; listed by analysis_methods().

[[nodiscard]] AnalysisMethod pendulum_method();
[[nodiscard]] AnalysisMethod projectile_method();
[[nodiscard]] AnalysisMethod incline_method();
[[nodiscard]] AnalysisMethod spring_method();
[[nodiscard]] AnalysisMethod collision_method();
[[nodiscard]] AnalysisMethod rigid_body_method();
[[nodiscard]] AnalysisMethod path_method();
[[nodiscard]] AnalysisMethod foucault_method();

}  // namespace kinectlab
