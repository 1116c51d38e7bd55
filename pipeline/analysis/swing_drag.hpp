#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/analysis/least_squares.hpp"

namespace kinectlab {

/// How the air takes the swing away: as the speed, as its square, or both.
enum class DragLaw { linear, quadratic, both };

/// The fit under one law.
struct DragModel {
    DragLaw law = DragLaw::linear;
    SwingParameters parameters;
    double weight = 1.0;  ///< how likely it is, from Schwarz's criterion; all add up to 1
};

/// What the positions say about the drag.
struct DragChoice {
    DragLaw law = DragLaw::linear;
    SwingParameters parameters;     ///< the fit under that law
    std::vector<DragModel> models;  ///< the admissible ones, the chosen one among them
    /// F of 1 and many degrees of freedom: by how much the sum of squares grows without the linear
    /// and without the quadratic term, against the noise that the residuals show.
    double f_linear = 0.0;
    double f_quadratic = 0.0;
    bool told_apart = false;   ///< linear from quadratic drag
    bool linear_seen = false;  ///< beside the quadratic term, under the law `both`
    /// 1/rad, under the law `quadratic`: what a linear drag that is too weak to be seen may do to
    /// the quadratic term.
    double quadratic_u_by_linear = 0.0;
};

/// Free under this law, of what `base` frees.
[[nodiscard]] SwingMask drag_mask(SwingMask base, DragLaw law);

/// Fits all three laws from `start` (both terms free and at their best) and compares the sums of
/// squares: Schwarz, Ann. Statist. 6 (1978), each sum divided by `widening`, the factor by which
/// noise that lasts makes the variance of the two drag terms larger. A term that comes out negative
/// where it stands beside the other, or quadratic drag that pushes, is not admissible; quadratic
/// drag alone is chosen only where it is better by 6, which Kass and Raftery, JASA 90 (1995), call
/// strong. Even then both terms are given where the linear one is admissible: too weak to be seen
/// is not zero, and the quadratic one depends on it.
[[nodiscard]] DragChoice choose_drag(
    std::span<const PositionSample> samples,
    const SwingParameters& start,
    const SwingWeights& weights,
    const SwingPriors& priors,
    const SwingMask& base,
    double widening
);

/// Root mean square of a number that cannot be negative, estimated as `value` with this standard
/// uncertainty by who did not know that.
[[nodiscard]] double rms_if_positive(double value, double u);

}  // namespace kinectlab
