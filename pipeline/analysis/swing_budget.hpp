#pragma once

#include <functional>
#include <string>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/analysis/swing_fit.hpp"

namespace kinectlab {

using SwingFormula = std::function<double(const SwingParameters&)>;

/// How a number changes with what is not a parameter of the fit.
struct SwingSensitivity {
    double clock = 0.0;   ///< by a relative error of the clock's rate
    double length = 0.0;  ///< by length_m itself, for each metre, the fit left as it is
    double scale = 0.0;   ///< by a relative error of all lengths seen, the fit left as it is
    /// Whether the number means the same under every drag law.
    bool any_drag = true;
    double other_drag = 0.0;  ///< what drag that was not seen does, where that is known otherwise
};

/// Makes measurements of formulas on a fit's parameters, each with the lines "statistics",
/// "camera tilt", "length", "clock", "depth scale" and "model choice", after GUM 5.1.2.
/// "statistics" holds what the arc says of its own radius if no length was given.
class SwingBudgets {
public:
    SwingBudgets(const SwingFit& fit, const PendulumSettings& settings);

    [[nodiscard]] Measurement measure(
        std::string name,
        std::string unit,
        const SwingFormula& formula,
        const SwingSensitivity& sensitivity = {}
    ) const;

private:
    const SwingFit& fit_;
    const PendulumSettings& settings_;
    SwingVector step_;
};

}  // namespace kinectlab
