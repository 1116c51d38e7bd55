#pragma once

#include <Eigen/Core>

#include "pipeline/core/time.hpp"

namespace kinectlab {

/// Where a thing should be now: a Kalman filter of constant velocity whose acceleration is white
/// noise (Bar-Shalom, Li & Kirubarajan 2001, section 6.2.2), the same along the three axes. A plain
/// value.
class PredictedPoint {
public:
    PredictedPoint() = default;

    /// Seen for the first time; `variance` of the position along an axis, m². Its velocity is not
    /// known.
    PredictedPoint(TimeNs t, const Eigen::Vector3d& p_cam, double variance);

    /// Seen again, not earlier than the last time.
    void observe(TimeNs t, const Eigen::Vector3d& p_cam, double variance);

    [[nodiscard]] Eigen::Vector3d at(TimeNs t) const;
    /// Of that place along an axis, m²: it grows with t³ while nothing is seen.
    [[nodiscard]] double variance_at(TimeNs t) const;
    [[nodiscard]] TimeNs seen_at() const { return t_; }

private:
    TimeNs t_ = 0;
    Eigen::Vector3d p_ = Eigen::Vector3d::Zero(), v_ = Eigen::Vector3d::Zero();
    double pp_ = 0.0, pv_ = 0.0, vv_ = 0.0;  // covariance of place and velocity along an axis
};

}  // namespace kinectlab
