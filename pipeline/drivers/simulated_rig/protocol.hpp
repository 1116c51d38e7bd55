#pragma once

#include <cstdint>

/// What the simulated rig's OpenNI2 device understands beyond the standard properties. Plain
/// structs of doubles, passed with openni::Device::setProperty and getProperty.
namespace kinectlab::simulated_rig {

enum Property : int {
    kPendulum = 0x4B4C0001,  ///< set/get PendulumParameters; takes effect at once, bob at rest
    kActuator = 0x4B4C0002,  ///< set ActuatorCommand
    kState = 0x4B4C0003,     ///< get RigState
    kGeometry = 0x4B4C0004,  ///< get CameraGeometry
    kFault = 0x4B4C0005,     ///< set Fault, to try what happens when hardware fails
};

struct PendulumParameters {
    double length_m = 1.0;  ///< pivot to the bob's centre
    double bob_radius_m = 0.05;
    double gravity_m_s2 = 9.81;
    double latitude_deg = 45.0;
    double damping_per_s = 0.002;  ///< amplitude decays as exp(-damping t)
};

enum class Action : std::int32_t {
    stop = 0,      ///< brake the bob until it hangs at rest
    displace = 1,  ///< bring the bob to angle_rad in the x-z plane of the lab, and hold it there
    hold = 2,      ///< switch the electromagnet on where the bob is
    release = 3,   ///< switch the electromagnet off
};

struct ActuatorCommand {
    Action action = Action::stop;
    std::int32_t reserved = 0;
    double angle_rad = 0.0;
};

enum class Motion : std::int32_t {
    at_rest = 0,
    moving_to_angle = 1,
    held = 2,
    swinging = 3,
    braking = 4
};

/// The truth at the time of the newest frame; tests compare with it, the pipeline never sees it.
struct RigState {
    Motion motion = Motion::at_rest;
    std::int32_t reserved = 0;
    double device_time_s = 0.0;
    double angle_rad = 0.0;    ///< between the string and the vertical
    double bob_x_lab_m = 0.0;  ///< bob's centre
    double bob_y_lab_m = 0.0;
    double bob_z_lab_m = 0.0;
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
