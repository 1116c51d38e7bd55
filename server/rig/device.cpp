#include "server/rig/device.hpp"

#include "pipeline/sensor/openni_source.hpp"
#include "server/rig/simulated_actuator.hpp"

namespace kinectlab::rig {
namespace {

/// A camera without anything that moves the bob: live pictures, but no runs.
class NoActuator final : public Actuator {
public:
    Result<void> configure(const std::string&, const lab::Parameters&) override { return none(); }
    Result<void> displace(double) override { return none(); }
    Result<void> hold() override { return none(); }
    Result<void> release() override { return none(); }
    Result<void> stop() override { return {}; }  // nothing here ever set the bob in motion
    Result<ActuatorState> state() override { return tl::unexpected(none().error()); }

private:
    static Result<void> none() {
        return fail(ErrorCode::unavailable, "actuator", "this rig has none yet");
    }
};

}  // namespace

bool is_simulated(const std::string& uri) {
    return uri.starts_with("sim://");
}

Result<Device> open_device(const std::string& uri) {
    auto source = OpenniSource::open({.uri = uri});
    if (!source) return tl::unexpected(source.error());
    Device device;
    if (is_simulated(uri)) {
        device.actuator = make_simulated_actuator(**source);
    } else {
        device.actuator = std::make_unique<NoActuator>();
    }
    device.source = std::move(*source);
    return device;
}

}  // namespace kinectlab::rig
