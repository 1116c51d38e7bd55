#include "pipeline/analysis/incline_rolling.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace kinectlab {

double rolling_inertia(double radius_m, double groove_width_m) {
    if (groove_width_m == 0.0) return 1.4;
    const double r2 = radius_m * radius_m;
    return 1.0 + 0.4 * r2 / (r2 - groove_width_m * groove_width_m / 4.0);
}

RollingDecision decide_rolling(
    const Measurement& by_rolling, double inertia, const LocalGravity& local
) {
    const double u = std::hypot(by_rolling.u, local.u);
    const double z = (by_rolling.value - local.g) / u;
    const double range = (inertia - 1.0) * local.g;
    const double rolls = std::exp(-z * z / 2.0) / (u * std::sqrt(2.0 * std::numbers::pi));
    const auto below = [](double x) {
        return 0.5 * std::erfc(-x / std::numbers::sqrt2);
    };
    const double slides = (below(z) - below(z - range / u)) / range;
    RollingDecision decision;
    // Beyond both, numbers that small are rounding: the nearer one is meant.
    decision.rolling = rolls + slides > 1e-300 ? rolls / (rolls + slides) : (z < 0.0 ? 1.0 : 0.0);
    decision.text = fmt::format(
        "Rolling {:.1f} %, sliding {:.1f} %: if it rolls, g is {:.3f} ± {:.3f} m/s², against "
        "{:.4f} "
        "m/s² at this place.",
        100.0 * decision.rolling,
        100.0 * (1.0 - decision.rolling),
        by_rolling.value,
        by_rolling.u,
        local.g
    );
    if (z < -4.0)
        decision.warning =
            "It speeds up more slowly than a rolling ball: does something brake it, "
            "is it hollow, or is the angle wrong?";
    else if (z - range / u > 4.0)
        decision.warning =
            "It speeds up more than anything sliding could: are the angle and the "
            "scale right?";
    else if (decision.rolling >= kSurelySliding && decision.rolling < 0.5)
        decision.warning =
            "Whether the ball rolls or slides is not sure; g takes for granted that "
            "it rolls.";
    else if (range < 2.0 * u)
        decision.warning =
            "The angle is not known well enough to tell rolling from sliding; g "
            "takes for granted that it rolls.";
    return decision;
}

}  // namespace kinectlab
