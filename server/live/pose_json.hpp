#pragma once

#include <cstdint>
#include <string>

#include "server/bus/events.hpp"

namespace kinectlab::live {

/// {"type":"pose","seq":7,"t_ns":…,"object":"bob","status":"tracked","p":[…],"v":[…],"s":[…]
/// without its end: `,"missed":0}` differs by viewer and is sent after it. p, v, s are null where
/// the pose is lost; the quaternion q (x, y, z, w) is there only where the orientation is known.
[[nodiscard]] std::string encode_pose(const bus::PoseMeasured& pose, std::uint64_t seq);

[[nodiscard]] std::string missed_tail(std::uint64_t missed);

/// [t_ns,x,y,z,"object"], as in the trail.
[[nodiscard]] std::string encode_trail_point(const std::string& object, const MotionSample& sample);

}  // namespace kinectlab::live
