#pragma once

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/path_numbers.hpp"

namespace kinectlab {

/// The map with headings as ticks, and speed, turning rate and heading against time with their
/// uncertainties. Without a metre the speed is left out.
[[nodiscard]] std::vector<Plot> path_plots(
    const SmoothPath& path, const ObjectFit& fit, const PathNumbers& numbers, bool metric
);

}  // namespace kinectlab
