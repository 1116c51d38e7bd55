#include "pipeline/analysis/path_budget.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {

using Eigen::VectorXd;

PathBudget::PathBudget(
    const PathFit& fit, std::vector<PriorLine> priors, const AnalysisConditions& conditions
)
    : fit_(fit), priors_(std::move(priors)), conditions_(conditions) {}

Measurement PathBudget::measure(
    const std::string& name,
    const std::string& unit,
    const std::function<double(const VectorXd&)>& formula,
    const Powers& powers,
    const std::vector<BudgetLine>& more
) const {
    const VectorXd g = gradient_of(formula, fit_);
    Measurement m{name, formula(fit_.parameters), 0.0, unit, {}};
    m.budget.push_back({"statistics", std::sqrt(std::max(g.dot(fit_.from_noise * g), 0.0))});
    const VectorXd by_prior = fit_.by_prior.transpose() * g;
    for (const auto& line : priors_) {
        double sum = 0.0;
        for (const int i : line.parameters)
            sum += by_prior[i] * by_prior[i];
        m.budget.push_back({line.source, std::sqrt(sum)});
    }
    if (conditions_.metric && powers.length != 0.0)
        m.budget.push_back(
            {"depth scale", std::abs(powers.length * m.value) * conditions_.depth_scale_u}
        );
    if (powers.time != 0.0)
        m.budget.push_back({"clock", std::abs(powers.time * m.value) * conditions_.clock_u});
    m.budget.insert(m.budget.end(), more.begin(), more.end());
    m.u = combined(m.budget);
    return m;
}

}  // namespace kinectlab
