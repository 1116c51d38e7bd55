#pragma once

#include <vector>

#include "pipeline/analysis/pendulum.hpp"

namespace kinectlab {

/// The settings that every analysis of a pendulum takes: its length, bob, string and air.
[[nodiscard]] std::vector<AnalysisSetting> pendulum_setting_list();

/// From the checked settings and the conditions of the run.
[[nodiscard]] PendulumSettings pendulum_settings(
    const AnalysisSettings& settings, const AnalysisConditions& conditions
);

}  // namespace kinectlab
