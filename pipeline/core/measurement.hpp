#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace kinectlab {

/// One source of uncertainty; independent of the other lines of its budget.
struct BudgetLine {
    std::string source;
    double u = 0.0;  ///< standard uncertainty it causes, in the measurement's unit
};

/// A value never travels without its uncertainty and unit.
struct Measurement {
    std::string name;
    double value = 0.0;
    double u = 0.0;    ///< standard uncertainty, k = 1
    std::string unit;  ///< SI, "1" for a pure number
    std::vector<BudgetLine> budget;
};

/// The root sum of squares of the budget (GUM 5.1.2, uncorrelated inputs).
inline double combined(const std::vector<BudgetLine>& budget) {
    double sum = 0.0;
    for (const auto& line : budget)
        sum += line.u * line.u;
    return std::sqrt(sum);
}

}  // namespace kinectlab
