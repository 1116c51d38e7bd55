#pragma once

#include <optional>
#include <string>

#include "pipeline/analysis/normal_gravity.hpp"
#include "pipeline/core/measurement.hpp"

namespace kinectlab {

/// Below this probability of rolling the ball is taken to slide.
constexpr double kSurelySliding = 0.05;

/// g sin α / a of a solid ball that rolls on a plank (7/5) or on the two edges of a groove of that
/// width, which it touches nearer to its axis: 1 + (2/5) r²/(r² - w²/4). Radius and width in m.
[[nodiscard]] double rolling_inertia(double radius_m, double groove_width_m);

struct RollingDecision {
    double rolling = 0.5;  ///< probability
    std::string text;
    std::optional<std::string> warning;
};

/// Rolling or sliding, each as likely before. A ball that rolls makes `by_rolling`, g taken for
/// granted that it does, the local g; one that slides with a friction that it does not say makes it
/// anything from there to `inertia` times that (at larger friction it would roll). Bayes' rule with
/// the uncertainties of both numbers.
[[nodiscard]] RollingDecision decide_rolling(
    const Measurement& by_rolling, double inertia, const LocalGravity& local
);

}  // namespace kinectlab
