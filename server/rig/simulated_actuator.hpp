#pragma once

#include <memory>

#include "pipeline/sensor/openni_source.hpp"
#include "server/rig/actuator.hpp"

namespace kinectlab::rig {

/// The arms, magnets and brakes of a simulated rig, reached through its device's properties.
/// `source` must outlive the actuator.
[[nodiscard]] std::unique_ptr<Actuator> make_simulated_actuator(OpenniSource& source);

}  // namespace kinectlab::rig
