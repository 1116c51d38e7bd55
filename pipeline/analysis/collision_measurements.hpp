#pragma once

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/analysis/collision_fit.hpp"

namespace kinectlab {

struct BallMasses {
    double a = 0.0;  ///< kg
    double b = 0.0;
    double u = 0.0;  ///< of each, independent, kg
};

/// Which way is along, in the lab frame, for one set of parameters.
namespace collision {
/// Direction of the relative velocity before the impact, of length one.
[[nodiscard]] Eigen::Vector3d approach(const Eigen::VectorXd& parameters);
/// True where the fit shows in which direction one centre lies from the other at the impact.
[[nodiscard]] bool shows_centres(const ResidualFit& fit);
}  // namespace collision

/// The collision's numbers with their budgets, and notes on how they are meant. Without a metre
/// only those that need none.
void add_collision_measurements(
    const ResidualFit& fit,
    const BallMasses& masses,
    const AnalysisConditions& conditions,
    AnalysisOutcome& outcome
);

}  // namespace kinectlab
