#pragma once

#include "pipeline/core/disparity.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/track/fitted_shape.hpp"
#include "pipeline/track/shape.hpp"
#include "pipeline/track/shape_pixels.hpp"

namespace kinectlab {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// By what rules a sphere, cylinder or cone settles on its pixels.
struct RoundWay {
    double sigma = 0.0;             ///< of a reading, steps
    double gate_steps = 0.0;        ///< closes while the shape settles
    double rim_m = 0.0;             ///< inside the outline: left out
    double low = -1e6, high = 1e6;  ///< along the axis: beyond is left out
    bool choose = true;             ///< the pixels anew, for the shape as it is now
    bool chosen = false;            ///< they are already for the shape as it is now
    double settled = 0.0;           ///< a step of so many standard deviations is the last
    int most_steps = kMostFitSteps;
    bool may_stop_short = false;   ///< else not to settle in so many steps is a failure
    std::array<bool, 6> active{};  ///< of t1, t2, t3, ω1, ω2 and the size
    Eigen::Matrix3d R_cam_shape = Eigen::Matrix3d::Identity();

    [[nodiscard]] bool has_ends() const { return low > -1e5; }
};

/// Normal equations of one step, in the shape's own frame.
struct RoundEquations {
    Matrix6d information = Matrix6d::Identity();
    Vector6d gradient = Vector6d::Zero();
    double pixels = 0.0;
};

/// Which unknowns a kind has.
[[nodiscard]] RoundUnknowns unknowns_of(ShapeKind kind, bool fixed_size);

/// used = 1 for the pixels that surely show the shape: inside its outline and between its ends.
void choose_shape_pixels(
    ShapePixels& pixels, const DisparityScale& scale, const Shape& shape, const RoundWay& way
);

/// Residual, weight and height of every pixel; the next step's equations.
RoundEquations linearise_shape(
    ShapePixels& pixels, const DisparityScale& scale, const Shape& shape, const RoundWay& way
);

/// Gauss-Newton steps while the gate closes. False if it does not settle.
[[nodiscard]] bool settle(
    ShapePixels& pixels,
    const DisparityScale& scale,
    Shape& shape,
    RoundWay& way,
    RoundEquations& sums
);

}  // namespace kinectlab
