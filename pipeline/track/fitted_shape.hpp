#pragma once

#include <numbers>

#include "pipeline/core/track_sample.hpp"
#include "pipeline/track/shape.hpp"

namespace kinectlab {

/// A refined shape and how surely it is known.
struct ShapeFit {
    /// A plane's point is the middle of what is seen of it, a cylinder's that of its seen length.
    Shape shape;
    /// Of shape.point (m²), then of the rotation vector (rad²), camera frame. What the shape does
    /// not show, the turn about its own axis, has the variance of an angle that may be anything,
    /// π²/3; of a sphere's rotation nothing is said (zero).
    Matrix6d covariance = Matrix6d::Zero();
    double size_u = 0.0;           ///< standard uncertainty of a free radius (m) or angle (rad)
    double low = 0.0, high = 0.0;  ///< cylinder and cone: seen from here to there along the axis, m
    TrackQuality quality;
    double cost = 1.0;  ///< mean of Tukey's loss over all pixels offered: 0 all on it, 1 none
};

/// Of an angle that may be anything, rad².
inline constexpr double kAnyAngle = std::numbers::pi * std::numbers::pi / 3.0;

inline constexpr double kLastGateSigmas = 6.0;    ///< of residuals: beyond is an outlier
inline constexpr double kFirstGateSigmas = 24.0;  ///< while the guess's own error is in them
inline constexpr double kFewestFitPixels = 24.0;  ///< offered; half of them must count
inline constexpr int kMostFitSteps = 24;

}  // namespace kinectlab
