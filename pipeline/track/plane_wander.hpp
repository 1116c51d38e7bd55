#pragma once

#include <Eigen/Core>

#include "pipeline/core/time.hpp"

namespace kinectlab {

/// How far the middle of what is seen of a plane wanders along it from frame to frame, since pieces
/// of it are seen in one frame and not in the next. Measured from three middles in a row, so that
/// a steady motion is none; a share of the plane's size is expected before anything is seen. A
/// plain value.
class PlaneWander {
public:
    /// Variance along each of the plane's axes, m², of the middle seen at `t`, camera frame.
    /// `area_m2` is what is seen of the plane.
    [[nodiscard]] double variance(
        TimeNs t,
        const Eigen::Vector3d& middle_cam,
        const Eigen::Vector3d& normal_cam,
        double area_m2
    );

private:
    TimeNs seen_at_ = 0;
    int in_a_row_ = 0;
    Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), before_ = Eigen::Vector3d::Zero();
    double measured_ = 0.0, comparisons_ = 0.0;
};

}  // namespace kinectlab
