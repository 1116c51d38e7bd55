#pragma once

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab {

// Each in the .cpp of its name; listed by analysis_methods().

[[nodiscard]] AnalysisMethod pendulum_method();
[[nodiscard]] AnalysisMethod foucault_method();

}  // namespace kinectlab
