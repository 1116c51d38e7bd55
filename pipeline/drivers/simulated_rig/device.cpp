#include "pipeline/drivers/simulated_rig/device.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipeline/drivers/simulated_rig/properties.hpp"
#include "pipeline/simulate/apparatus_text.hpp"

namespace kinectlab::simulated_rig {
namespace {

constexpr double kLongestFault = 3600.0;  ///< s
constexpr OniVersion kDriverVersion = {0, 1, 0, 0};

OniStatus status_of(const Result<void>& result) {
    return result ? ONI_STATUS_OK : ONI_STATUS_BAD_PARAMETER;
}

BodyState to_state(const simulate::Body& body) {
    BodyState state;
    body.name.copy(state.name, sizeof(state.name) - 1);
    Eigen::Map<Eigen::Vector3d>(state.p_lab_m) = body.p_lab;
    Eigen::Map<Eigen::Vector4d>(state.q_lab_body) = body.q_lab_body.coeffs();
    Eigen::Map<Eigen::Vector3d>(state.v_lab_m_s) = body.v_lab;
    Eigen::Map<Eigen::Vector3d>(state.w_lab_rad_s) = body.w_lab;
    return state;
}

void copy_row_major(const Eigen::Isometry3d& T, double (&out)[16]) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            out[4 * row + column] = T.matrix()(row, column);
}

}  // namespace

Device::Device(std::string serial, const simulate::RigSettings& settings, Unplug unplug)
    : serial_(std::move(serial)),
      unplug_(std::move(unplug)),
      modes_{video_mode(ONI_SENSOR_DEPTH), video_mode(ONI_SENSOR_COLOR)},
      sensors_{
          OniSensorInfo{ONI_SENSOR_DEPTH, 1, &modes_[0]},
          OniSensorInfo{ONI_SENSOR_COLOR, 1, &modes_[1]}},
      rig_(
          settings,
          [this] {
              const std::lock_guard lock(streams_mutex_);
              return std::any_of(streams_.begin(), streams_.end(), [](const auto& stream) {
                  return stream->running();
              });
          },
          [this](const RgbdFrame& frame) {
              const std::lock_guard lock(streams_mutex_);
              for (const auto& stream : streams_)
                  stream->deliver(frame);
          }
      ) {}

OniStatus Device::getSensorInfoList(OniSensorInfo** infos, int* count) {
    *infos = sensors_.data();
    *count = static_cast<int>(sensors_.size());
    return ONI_STATUS_OK;
}

oni::driver::StreamBase* Device::createStream(OniSensorType sensor) {
    if (sensor != ONI_SENSOR_DEPTH && sensor != ONI_SENSOR_COLOR) return nullptr;
    if (sensor == ONI_SENSOR_COLOR) rig_.turn_on_colour();
    const std::lock_guard lock(streams_mutex_);
    streams_.push_back(std::make_unique<Stream>(sensor, rig_.camera()));
    return streams_.back().get();
}

void Device::destroyStream(oni::driver::StreamBase* gone) {
    const std::lock_guard lock(streams_mutex_);
    std::erase_if(streams_, [gone](const auto& stream) { return stream.get() == gone; });
}

OniStatus Device::setProperty(int id, const void* data, int size) {
    if (unplugged_) return ONI_STATUS_NO_DEVICE;
    switch (id) {
        case kApparatus:
            return set_apparatus(data, size);
        case kActuator:
            return command_actuator(data, size);
        case kFault:
            return set_fault(data, size);
        case ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION: {
            OniImageRegistrationMode mode{};
            if (!take(mode, data, size)) return ONI_STATUS_BAD_PARAMETER;
            return mode == ONI_IMAGE_REGISTRATION_OFF ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
        }
        default:
            return ONI_STATUS_NOT_SUPPORTED;
    }
}

OniStatus Device::getProperty(int id, void* data, int* size) {
    if (unplugged_) return ONI_STATUS_NO_DEVICE;
    switch (id) {
        case kApparatus:
            return give_text(simulate::to_text(rig_.apparatus()), data, size);
        case kState:
            return give(state(), data, size);
        case kGeometry:
            return give(geometry(), data, size);
        case ONI_DEVICE_PROPERTY_FIRMWARE_VERSION:
            return give_text("simulated", data, size);
        case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
            return give(kDriverVersion, data, size);
        case ONI_DEVICE_PROPERTY_HARDWARE_VERSION:
            return give(1, data, size);
        case ONI_DEVICE_PROPERTY_SERIAL_NUMBER:
            return give_text(serial_, data, size);
        case ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION:
            return give(ONI_IMAGE_REGISTRATION_OFF, data, size);
        default:
            return ONI_STATUS_NOT_SUPPORTED;
    }
}

OniBool Device::isPropertySupported(int id) {
    return (id >= ONI_DEVICE_PROPERTY_FIRMWARE_VERSION && id <= ONI_DEVICE_PROPERTY_SERIAL_NUMBER
           ) ||
           id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || (id >= kApparatus && id <= kFault);
}

OniStatus Device::set_apparatus(const void* data, int size) {
    if (data == nullptr || size <= 0 || size > kLongestApparatus) return ONI_STATUS_BAD_PARAMETER;
    const std::string_view text(static_cast<const char*>(data), static_cast<std::size_t>(size));
    const auto settings = simulate::parse_apparatus(text);
    if (!settings) return ONI_STATUS_BAD_PARAMETER;
    return status_of(rig_.set_apparatus(*settings));
}

OniStatus Device::command_actuator(const void* data, int size) {
    ActuatorCommand command;
    if (!take(command, data, size)) return ONI_STATUS_BAD_PARAMETER;
    switch (command.action) {
        case Action::stop:
            return status_of(rig_.apply({simulate::Action::stop, 0.0}));
        case Action::displace:
            return status_of(rig_.apply({simulate::Action::displace, command.value}));
        case Action::hold:
            return status_of(rig_.apply({simulate::Action::hold, 0.0}));
        case Action::release:
            return status_of(rig_.apply({simulate::Action::release, 0.0}));
    }
    return ONI_STATUS_BAD_PARAMETER;
}

OniStatus Device::set_fault(const void* data, int size) {
    Fault fault;
    if (!take(fault, data, size)) return ONI_STATUS_BAD_PARAMETER;
    const bool known = fault.kind >= FaultKind::none && fault.kind <= FaultKind::actuator_silent;
    if (!known || !(fault.seconds >= 0.0 && fault.seconds <= kLongestFault))
        return ONI_STATUS_BAD_PARAMETER;
    if (fault.kind == FaultKind::unplugged) {
        unplugged_ = true;
        rig_.set_fault(fault.kind, std::chrono::duration<double>(2.0 * kLongestFault));
        unplug_(fault.seconds);
        return ONI_STATUS_OK;
    }
    rig_.set_fault(fault.kind, std::chrono::duration<double>(fault.seconds));
    return ONI_STATUS_OK;
}

RigState Device::state() const {
    const auto [truth, motion_since_s] = rig_.seen();
    RigState state;
    state.motion = static_cast<Motion>(truth.motion);
    state.device_time_s = truth.t_s;
    state.value = truth.value;
    state.motion_since_s = motion_since_s;
    const std::size_t count = std::min(truth.bodies.size(), std::size(state.bodies));
    state.body_count = static_cast<std::int32_t>(count);
    for (std::size_t i = 0; i < count; ++i)
        state.bodies[i] = to_state(truth.bodies[i]);
    return state;
}

CameraGeometry Device::geometry() const {
    const RgbdCamera& camera = rig_.camera();
    CameraGeometry geometry{};
    geometry.depth_fx = camera.depth.fx;
    geometry.depth_fy = camera.depth.fy;
    geometry.depth_cx = camera.depth.cx;
    geometry.depth_cy = camera.depth.cy;
    geometry.colour_fx = camera.colour.fx;
    geometry.colour_fy = camera.colour.fy;
    geometry.colour_cx = camera.colour.cx;
    geometry.colour_cy = camera.colour.cy;
    copy_row_major(camera.T_colour_depth, geometry.T_colour_depth);
    copy_row_major(rig_.T_lab_cam(), geometry.T_lab_cam);
    geometry.inverse_depth_step = camera.noise.inverse_depth_step;
    geometry.sigma_steps = camera.noise.sigma_steps;
    geometry.depth_scale_u = camera.depth_scale_u;
    geometry.tilt_u_rad = camera.tilt_u_rad;
    geometry.clock_u = camera.clock_u;
    return geometry;
}

}  // namespace kinectlab::simulated_rig
