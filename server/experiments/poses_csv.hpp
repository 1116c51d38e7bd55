#pragma once

#include <string>

#include "pipeline/core/trajectory.hpp"

namespace kinectlab::experiments {

/// The head line of the project's pose tables, with its newline:
/// t_ns,object,status,x,y,z,qx,qy,qz,qw,sx,sy,sz,vx,vy,vz,wx,wy,wz,
/// srx,sry,srz,radius,s_radius,half_angle,s_half_angle,points,inlier_share,rms_steps
/// Lab frame, SI units (ns, m, m/s, rad, rad/s); v and w are the velocities. s is a standard
/// uncertainty: of the position, of a turn about the lab's axes (sr), of a free radius of a sphere
/// or cylinder, of the free angle between a cone's axis and its surface. points are the depth
/// pixels that the pose rests on, inlier_share their share of those offered, rms_steps the residual
/// along the viewing rays in disparity steps. New columns come at the end: readers go by the names.
[[nodiscard]] const std::string& poses_csv_header();

/// Adds one row. Numbers have as many digits as it takes to read the same number back. What was not
/// measured is an empty cell: everything of a lost object, orientation and w of a shape that does
/// not show it, whatever is NaN.
void append_pose_row(std::string& csv, const std::string& object, const MotionSample& sample);

[[nodiscard]] const char* to_text(TrackStatus status);

}  // namespace kinectlab::experiments
