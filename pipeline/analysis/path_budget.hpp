#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/path_fit.hpp"

namespace kinectlab {

/// A line of the budget for what was known of some parameters before.
struct PriorLine {
    std::string source;           ///< "camera tilt"
    std::vector<int> parameters;  ///< of the path
};

/// How a number changes with the units of the positions: as length^length · time^time.
struct Powers {
    double length = 0.0;
    double time = 0.0;
};

/// Makes measurements of numbers that follow from a fitted path, each with its budget after the GUM
/// (5.1.2, uncorrelated inputs): `statistics` from the positions' noise, one line for each prior,
/// `depth scale` and `clock`, and what the caller adds.
class PathBudget {
public:
    PathBudget(
        const PathFit& fit, std::vector<PriorLine> priors, const AnalysisConditions& conditions
    );

    /// `more`: lines of other sources, in the measurement's unit.
    [[nodiscard]] Measurement measure(
        const std::string& name,
        const std::string& unit,
        const std::function<double(const Eigen::VectorXd&)>& formula,
        const Powers& powers,
        const std::vector<BudgetLine>& more = {}
    ) const;

private:
    const PathFit& fit_;
    std::vector<PriorLine> priors_;
    AnalysisConditions conditions_;
};

}  // namespace kinectlab
