#pragma once

#include <cstdint>

/// What the simulated rig's OpenNI2 device understands beyond the standard properties. Plain
/// structs of doubles, and a text, passed with openni::Device::setProperty and getProperty.
namespace kinectlab::simulated_rig {

enum Property : int {
    /// set/get "NAME PARAMETER=VALUE …", at most kLongestApparatus bytes, without a closing zero
    /// when set; takes effect at once, at rest. Refused if the rig has no such apparatus, or that
    /// does not take the values.
    kApparatus = 0x4B4C0001,
    kActuator = 0x4B4C0002,  ///< set ActuatorCommand
    kState = 0x4B4C0003,     ///< get RigState
    kGeometry = 0x4B4C0004,  ///< get CameraGeometry
    kFault = 0x4B4C0005,     ///< set Fault, to try what happens when hardware fails
};

constexpr int kLongestApparatus = 2048;

enum class Action : std::int32_t {
    stop = 0,      ///< bring everything to rest
    displace = 1,  ///< bring it to its start, displaced by the value, and hold it there
    hold = 2,      ///< hold it where it is
    release = 3,   ///< let it go
};

struct ActuatorCommand {
    Action action = Action::stop;
    std::int32_t reserved = 0;
    double value = 0.0;  ///< rad for the pendulum, m where something else can be displaced
};

enum class Motion : std::int32_t { at_rest = 0, moving = 1, held = 2, free = 3, braking = 4 };

/// Where a body's centre is in the lab frame, how it is turned, and how fast both change.
struct BodyState {
    char name[16] = {};  ///< with its closing zero
    double p_lab_m[3] = {};
    double q_lab_body[4] = {0.0, 0.0, 0.0, 1.0};  ///< x, y, z, w
    double v_lab_m_s[3] = {};
    double w_lab_rad_s[3] = {};
};

/// The truth at the time of the newest frame; tests compare with it, the pipeline never sees it.
struct RigState {
    Motion motion = Motion::at_rest;
    std::int32_t body_count = 0;
    double device_time_s = 0.0;
    double value = 0.0;           ///< of what displace sets, as it is now
    double motion_since_s = 0.0;  ///< device time from which on it moves so
    BodyState bodies[4];
};

/// Both cameras and where the depth camera stands.
struct CameraGeometry {
    double depth_fx, depth_fy, depth_cx, depth_cy;
    double colour_fx, colour_fy, colour_cx, colour_cy;
    double T_colour_depth[16];  ///< row-major, p_colour = T p_depth
    double T_lab_cam[16];       ///< row-major, p_lab = T p_cam (depth camera)
    double inverse_depth_step;  ///< 1/m for each disparity step
    double sigma_steps;
    double depth_scale_u;
    double tilt_u_rad;
    double clock_u;
};

enum class FaultKind : std::int32_t {
    none = 0,
    unplugged = 1,
    frozen = 2,
    black = 3,
    actuator_silent = 4
};

struct Fault {
    FaultKind kind = FaultKind::none;
    std::int32_t reserved = 0;
    double seconds = 0.0;  ///< how long it lasts
};

}  // namespace kinectlab::simulated_rig
