#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include <Eigen/Geometry>

#include "pipeline/core/time.hpp"

namespace kinectlab {

enum class TrackStatus : std::uint8_t {
    tracked,       ///< Measured in this frame.
    interpolated,  ///< Not seen in this frame; filled in from its neighbours in time.
    lost,          ///< Not seen, and too far from a frame where it was; the pose is NaN.
};

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// How much a pose can be trusted.
struct TrackQuality {
    int points = 0;             ///< depth pixels that the pose rests on
    double inlier_share = 0.0;  ///< of the pixels offered, 0 to 1
    double rms_steps = 0.0;     ///< RMS residual along the viewing rays, disparity steps
    /// Why it is lost, for a person, as a constant of the program; empty where not known.
    std::string_view why_lost;
};

/// How large a shape is, where that was free and measured; NaN elsewhere.
struct ShapeSize {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double radius_m = kNone;  ///< sphere and cylinder
    double radius_u = kNone;
    double half_angle_rad = kNone;  ///< cone: between its axis and its surface
    double half_angle_u = kNone;
};

/// One object in one frame, in the depth camera's frame.
struct TrackSample {
    TimeNs t = 0;
    std::uint32_t object = 0;  ///< Index into the list of objects that the tracker was given.
    /// Which of the things that go by that object's name, from 1; 0 where it is one thing alone.
    std::uint32_t identity = 0;
    TrackStatus status = TrackStatus::lost;
    bool has_orientation = false;  ///< False where the shape does not show it: q is identity then.
    Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();  ///< m
    Eigen::Quaterniond q_cam_obj = Eigen::Quaterniond::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< position (m²), then rotation vector (rad²)
    TrackQuality quality;
    ShapeSize size;
};

}  // namespace kinectlab
