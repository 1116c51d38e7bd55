#pragma once

#include <functional>
#include <memory>
#include <string>

#include "pipeline/sensor/frame_source.hpp"
#include "server/rig/actuator.hpp"

namespace kinectlab::rig {

/// What a rig is made of. The actuator may use the source, so it goes first.
struct Device {
    std::unique_ptr<FrameSource> source;
    std::unique_ptr<Actuator> actuator;
};

using OpenDevice = std::function<Result<Device>()>;

/// Whether a URI names the simulated rig's driver.
[[nodiscard]] bool is_simulated(const std::string& uri);

/// The camera at this URI through OpenNI2, with the actuator that belongs to it.
/// Error unavailable where no such device is there.
[[nodiscard]] Result<Device> open_device(const std::string& uri);

}  // namespace kinectlab::rig
