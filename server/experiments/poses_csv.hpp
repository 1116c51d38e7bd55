#pragma once

#include <string>

#include "pipeline/core/trajectory.hpp"

namespace kinectlab::experiments {

/// The head line of the project's pose tables, with its newline:
/// t_ns,object,status,x,y,z,qx,qy,qz,qw,sx,sy,sz,vx,vy,vz,wx,wy,wz
/// Lab frame, SI units; s is the standard uncertainty of the position, v and w the velocities.
[[nodiscard]] const std::string& poses_csv_header();

/// Adds one row. Numbers have as many digits as it takes to read the same number back. What was not
/// measured is an empty cell: everything of a lost object, orientation and w of a shape that does
/// not show it, whatever is NaN.
void append_pose_row(std::string& csv, const std::string& object, const MotionSample& sample);

[[nodiscard]] const char* to_text(TrackStatus status);

}  // namespace kinectlab::experiments
