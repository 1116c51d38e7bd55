#pragma once

#include <string>

#include "pipeline/sensor/frame_source.hpp"
#include "pipeline/sensor/openni_device.hpp"

namespace kinectlab {

/// Cameras of an open device: from the simulated rig's kGeometry property where the driver has it,
/// else pinholes from the fields of view (square pixels, centre in the middle, 575.8 px where the
/// driver gives none), the colour camera nominally 25 mm beside a live device's depth camera.
[[nodiscard]] SourceInfo describe(const std::string& uri, OpenniDevice& device);

}  // namespace kinectlab
