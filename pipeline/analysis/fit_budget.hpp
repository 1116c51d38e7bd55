#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/residual_fit.hpp"

namespace kinectlab {

using FitFormula = std::function<double(const Eigen::VectorXd& parameters)>;

/// A number that is made of a fit's parameters, with its budget: `statistics` for the noise of what
/// was measured, one line for each name in `prior_names` (by parameter; empty: none), then
/// `others`, which are independent of the fit. Correlations among the parameters are in the first
/// lines.
[[nodiscard]] Measurement measure(
    std::string name,
    std::string unit,
    const FitFormula& formula,
    const ResidualFit& fit,
    const std::vector<std::string>& prior_names,
    std::vector<BudgetLine> others
);

/// What plots need of one object: measured and fitted at all of its samples' times; `path` gives
/// the fitted position at a time since the first sample in s, and NaN where the fit does not reach.
[[nodiscard]] ObjectFit plotted_fit(
    const Trajectory& trajectory, const std::function<Eigen::Vector3d(double)>& path
);

}  // namespace kinectlab
