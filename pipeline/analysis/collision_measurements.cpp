#include "pipeline/analysis/collision_measurements.hpp"

#include <cmath>

#include "pipeline/analysis/fit_budget.hpp"

namespace kinectlab {
namespace collision {

using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d approach(const VectorXd& p) {
    return (before(p, 0) - before(p, 1)).normalized();
}

bool shows_centres(const ResidualFit& fit) {
    const auto distance = [](const VectorXd& p) {
        return (centre(p, 1) - centre(p, 0)).norm();
    };
    const VectorXd g = gradient_of(distance, fit.parameters, fit.covariance());
    const double u = std::sqrt(std::max(g.dot(fit.covariance() * g), 0.0));
    return distance(fit.parameters) > 5.0 * u;
}

}  // namespace collision

namespace {

using collision::after;
using collision::approach;
using collision::before;
using Eigen::Vector3d;
using Eigen::VectorXd;
/// A number made of the fit's parameters and the two masses.
using MassFormula = std::function<double(const VectorXd& parameters, double a, double b)>;

constexpr double kAtRest = 3.0;  // standard uncertainties of a speed that is no more than noise

class Budgets {
public:
    Budgets(const ResidualFit& fit, const BallMasses& masses, const AnalysisConditions& conditions)
        : fit_(fit), masses_(masses), conditions_(conditions) {
        priors_[collision::kDrag] = "drag";
        priors_[collision::kSlope] = "slope";
        priors_[collision::kSlope + 1] = "slope";
    }

    /// `lengths` and `times` are the powers of a metre and of a second in the number.
    [[nodiscard]] Measurement number(
        const std::string& name,
        const std::string& unit,
        const MassFormula& formula,
        int lengths,
        int times,
        bool of_masses = true
    ) const {
        const auto at = [&](const VectorXd& p) {
            return formula(p, masses_.a, masses_.b);
        };
        const double value = at(fit_.parameters);
        std::vector<BudgetLine> lines;
        if (lengths != 0)
            lines.push_back({"depth scale", std::abs(lengths * value) * conditions_.depth_scale_u});
        if (times != 0) lines.push_back({"clock", std::abs(times * value) * conditions_.clock_u});
        if (of_masses) {
            const double by_a = by_mass(formula, 1e-4 * masses_.a, 0.0) / (2e-4 * masses_.a);
            const double by_b = by_mass(formula, 0.0, 1e-4 * masses_.b) / (2e-4 * masses_.b);
            lines.push_back({"mass", std::hypot(by_a, by_b) * masses_.u});
        }
        return measure(name, unit, at, fit_, priors_, std::move(lines));
    }

private:
    [[nodiscard]] double by_mass(const MassFormula& formula, double da, double db) const {
        const VectorXd& p = fit_.parameters;
        return formula(p, masses_.a + da, masses_.b + db) -
               formula(p, masses_.a - da, masses_.b - db);
    }

    const ResidualFit& fit_;
    BallMasses masses_;
    AnalysisConditions conditions_;
    std::vector<std::string> priors_{static_cast<std::size_t>(collision::kCount)};
};

/// The size of a velocity where it is more than noise, else its part along the approach: the size
/// of a ball that rests would be the size of the noise.
void add_speed(
    const Budgets& budgets,
    const std::string& name,
    const std::string& words,
    Vector3d (*velocity)(const VectorXd&, std::size_t),
    std::size_t ball,
    AnalysisOutcome& outcome
) {
    const auto size = [=](const VectorXd& p, double, double) {
        return velocity(p, ball).norm();
    };
    const auto part = [=](const VectorXd& p, double, double) {
        return velocity(p, ball).dot(approach(p));
    };
    Measurement m = budgets.number(name, "m/s", size, 1, -1, false);
    const Measurement along = budgets.number(name, "m/s", part, 1, -1, false);
    if (m.value < kAtRest * std::max(m.u, along.u)) {
        m = along;
        outcome.notes.push_back(
            words + " moved no faster than its noise; its speed is given along the line of approach"
        );
    }
    outcome.measurements.push_back(std::move(m));
}

double momentum(
    const VectorXd& p,
    double a,
    double b,
    Vector3d (*velocity)(const VectorXd&, std::size_t),
    const Vector3d& direction
) {
    return (a * velocity(p, 0) + b * velocity(p, 1)).dot(direction);
}

double energy(
    const VectorXd& p, double a, double b, Vector3d (*velocity)(const VectorXd&, std::size_t)
) {
    return 0.5 * (a * velocity(p, 0).squaredNorm() + b * velocity(p, 1).squaredNorm());
}

/// Horizontal, to the left of the approach.
Vector3d across(const VectorXd& p) {
    return Vector3d::UnitZ().cross(approach(p)).normalized();
}

void add_metric(const Budgets& budgets, AnalysisOutcome& outcome) {
    add_speed(budgets, "speed_a_before", "Before the impact ball a", before, 0, outcome);
    add_speed(budgets, "speed_b_before", "Before the impact ball b", before, 1, outcome);
    add_speed(budgets, "speed_a_after", "After the impact ball a", after, 0, outcome);
    add_speed(budgets, "speed_b_after", "After the impact ball b", after, 1, outcome);
    const auto add = [&](const char* name, const char* unit, const MassFormula& formula, int power
                     ) {
        outcome.measurements.push_back(budgets.number(name, unit, formula, power, -power));
    };
    add(
        "momentum_before",
        "kg m/s",
        [](const VectorXd& p, double a, double b) {
            return momentum(p, a, b, before, approach(p));
        },
        1
    );
    add(
        "momentum_after",
        "kg m/s",
        [](const VectorXd& p, double a, double b) { return momentum(p, a, b, after, approach(p)); },
        1
    );
    add(
        "momentum_balance",
        "kg m/s",
        [](const VectorXd& p, double a, double b) {
            return momentum(p, a, b, after, approach(p)) - momentum(p, a, b, before, approach(p));
        },
        1
    );
    add(
        "momentum_balance_across",
        "kg m/s",
        [](const VectorXd& p, double a, double b) {
            return momentum(p, a, b, after, across(p)) - momentum(p, a, b, before, across(p));
        },
        1
    );
    add(
        "energy_before",
        "J",
        [](const VectorXd& p, double a, double b) { return energy(p, a, b, before); },
        2
    );
    add(
        "energy_after",
        "J",
        [](const VectorXd& p, double a, double b) { return energy(p, a, b, after); },
        2
    );
}

}  // namespace

void add_collision_measurements(
    const ResidualFit& fit,
    const BallMasses& masses,
    const AnalysisConditions& conditions,
    AnalysisOutcome& outcome
) {
    const Budgets budgets(fit, masses, conditions);
    if (conditions.metric)
        add_metric(budgets, outcome);
    else
        outcome.notes.emplace_back(
            "Positions are in pixels: speeds, momenta and energies are left out; shares and the "
            "restitution need no metre."
        );
    outcome.measurements.push_back(budgets.number(
        "energy_lost_share",
        "1",
        [](const VectorXd& p, double a, double b) {
            return 1.0 - energy(p, a, b, after) / energy(p, a, b, before);
        },
        0,
        0
    ));
    const bool centres = collision::shows_centres(fit);
    outcome.notes.emplace_back(
        centres ? "The restitution is taken along the line of the centres at the impact."
                : "The line of the centres is not seen well enough; the restitution is taken along "
                  "the line of approach, which holds for a head-on impact."
    );
    outcome.measurements.push_back(budgets.number(
        "restitution",
        "1",
        [centres](const VectorXd& p, double, double) {
            const Vector3d n =
                centres ? Vector3d(collision::centre(p, 1) - collision::centre(p, 0)) : approach(p);
            return -(after(p, 0) - after(p, 1)).dot(n) / (before(p, 0) - before(p, 1)).dot(n);
        },
        0,
        0,
        false
    ));
    outcome.measurements.push_back(budgets.number(
        "impact_time",
        "s",
        [](const VectorXd& p, double, double) { return p[collision::kTime]; },
        0,
        1,
        false
    ));
}

}  // namespace kinectlab
