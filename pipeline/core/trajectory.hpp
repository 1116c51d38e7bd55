#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/time.hpp"
#include "pipeline/core/track_sample.hpp"

namespace kinectlab {

/// One object at one time in the lab frame (z up, x along the rig's main motion).
struct MotionSample {
    TimeNs t = 0;
    TrackStatus status = TrackStatus::lost;
    bool has_orientation = false;
    Eigen::Vector3d p_lab = Eigen::Vector3d::Zero();  ///< m
    Eigen::Quaterniond q_lab_obj = Eigen::Quaterniond::Identity();
    Matrix6d covariance = Matrix6d::Zero();           ///< position (m²), then rotation (rad²)
    Eigen::Vector3d v_lab = Eigen::Vector3d::Zero();  ///< m/s
    Eigen::Vector3d a_lab = Eigen::Vector3d::Zero();  ///< m/s²
    Eigen::Vector3d w_lab = Eigen::Vector3d::Zero();  ///< rad/s
    /// Standard uncertainties of v, a and w as the samples' covariances make them, each frame's
    /// noise by itself; NaN where a covariance is missing.
    Eigen::Vector3d sigma_v = Eigen::Vector3d::Zero();  ///< m/s
    Eigen::Vector3d sigma_a = Eigen::Vector3d::Zero();  ///< m/s²
    Eigen::Vector3d sigma_w = Eigen::Vector3d::Zero();  ///< rad/s
    TrackQuality quality;
    ShapeSize size;

    [[nodiscard]] Eigen::Vector3d sigma_p() const {
        return covariance.diagonal().head<3>().cwiseSqrt();
    }
};

/// Samples in strictly increasing time.
struct Trajectory {
    std::string object;
    std::vector<MotionSample> samples;
};

}  // namespace kinectlab
