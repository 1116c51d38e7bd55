#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

struct OpenniSettings {
    std::string uri;          ///< as OpenNI2 lists it, e.g. "sim://rig-1?seed=7"; empty: any device
    bool with_colour = true;  ///< also stream colour, paired with depth by time
};

/// A live device through OpenNI2. Disconnection is noticed, and the device is reopened when it is
/// back. One thread calls next(); set_property and get_property may be called from another.
class OpenniSource : public FrameSource {
public:
    /// Error `unavailable` names the URI and lists the devices that are there.
    [[nodiscard]] static Result<std::unique_ptr<OpenniSource>> open(const OpenniSettings& settings);

    /// Device properties of a driver of our own (the simulated rig's actuator, the Kinect's tilt).
    /// `data` is the property's plain struct; false if the device is gone or refuses the value.
    [[nodiscard]] virtual bool set_property(int id, std::span<const std::byte> data) = 0;
    [[nodiscard]] virtual bool get_property(int id, std::span<std::byte> data) = 0;

    /// A moment by the device's clock as the frames tell it; none before the first frame. For the
    /// thread that calls next().
    [[nodiscard]] virtual std::optional<TimeNs> utc_of(double device_s) const = 0;
};

/// URIs of the devices that OpenNI2 sees now.
[[nodiscard]] std::vector<std::string> list_openni_devices();

}  // namespace kinectlab
