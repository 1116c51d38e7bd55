#include "pipeline/analysis/fit_budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinectlab {

Measurement measure(
    std::string name,
    std::string unit,
    const FitFormula& formula,
    const ResidualFit& fit,
    const std::vector<std::string>& prior_names,
    std::vector<BudgetLine> others
) {
    Measurement m{std::move(name), formula(fit.parameters), 0.0, std::move(unit), {}};
    const Eigen::VectorXd g = gradient_of(formula, fit.parameters, fit.covariance());
    m.budget.push_back({"statistics", std::sqrt(std::max(g.dot(fit.from_noise * g), 0.0))});
    const Eigen::VectorXd by_prior = fit.by_prior.transpose() * g;
    for (Eigen::Index i = 0; i < by_prior.size(); ++i) {
        const std::string& source = prior_names[static_cast<std::size_t>(i)];
        if (source.empty()) continue;
        const auto line = std::find_if(m.budget.begin(), m.budget.end(), [&](const auto& one) {
            return one.source == source;
        });
        if (line == m.budget.end())
            m.budget.push_back({source, std::abs(by_prior[i])});
        else
            line->u = std::hypot(line->u, by_prior[i]);
    }
    m.budget.insert(m.budget.end(), others.begin(), others.end());
    m.u = combined(m.budget);
    return m;
}

ObjectFit plotted_fit(
    const Trajectory& trajectory, const std::function<Eigen::Vector3d(double)>& path
) {
    ObjectFit fit;
    fit.object = trajectory.object;
    for (const MotionSample& sample : trajectory.samples) {
        const bool seen = sample.status == TrackStatus::tracked;
        fit.t.push_back(sample.t);
        fit.p_lab.push_back(
            seen ? sample.p_lab
                 : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())
        );
        fit.fit_lab.push_back(path(to_seconds(sample.t - trajectory.samples.front().t)));
        fit.residual.emplace_back(fit.p_lab.back() - fit.fit_lab.back());
    }
    return fit;
}

}  // namespace kinectlab
