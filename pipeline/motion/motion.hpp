#pragma once

#include <span>
#include <string>

#include <Eigen/Geometry>

#include "pipeline/core/track_sample.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab {

struct MotionSettings {
    double frame_period_s = 1.0 / 30.0;  ///< nominal: a longer step in time is a gap of lost frames
    double max_gap_s = 0.25;             ///< longer gaps stay lost, nothing is invented
    double bandwidth_hz = 5.0;           ///< of the local polynomial that gives v and a
};

/// Samples of one object, in time order, camera frame → lab frame, gaps filled and marked, linear
/// and angular velocity and acceleration with their uncertainties. Samples without a pose are
/// "lost" and their values NaN.
[[nodiscard]] Trajectory to_trajectory(
    std::string object,
    std::span<const TrackSample> samples,
    const Eigen::Isometry3d& T_lab_cam,
    const MotionSettings& settings = {}
);

}  // namespace kinectlab
