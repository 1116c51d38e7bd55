#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/drivers/simulated_rig/rig_clock.hpp"
#include "pipeline/drivers/simulated_rig/stream.hpp"

namespace kinectlab::simulated_rig {

/// One opened rig. It starts as a pendulum at rest, and its clock at 0, when it is opened.
class Device : public oni::driver::DeviceBase {
public:
    /// Asked to take the device off the list, and to put it back after so many seconds.
    using Unplug = std::function<void(double seconds)>;

    Device(std::string serial, const simulate::RigSettings& settings, Unplug unplug);

    OniStatus getSensorInfoList(OniSensorInfo** infos, int* count) override;
    oni::driver::StreamBase* createStream(OniSensorType sensor) override;
    void destroyStream(oni::driver::StreamBase* stream) override;
    OniStatus setProperty(int id, const void* data, int size) override;
    OniStatus getProperty(int id, void* data, int* size) override;
    OniBool isPropertySupported(int id) override;

private:
    OniStatus set_apparatus(const void* data, int size);
    OniStatus command_actuator(const void* data, int size);
    OniStatus set_fault(const void* data, int size);
    [[nodiscard]] RigState state() const;
    [[nodiscard]] CameraGeometry geometry() const;

    const std::string serial_;
    const Unplug unplug_;
    std::array<OniVideoMode, 2> modes_;
    std::array<OniSensorInfo, 2> sensors_;
    std::atomic<bool> unplugged_ = false;
    std::mutex streams_mutex_;
    std::vector<std::unique_ptr<Stream>> streams_;
    RigClock rig_;  ///< last: its thread uses the streams
};

}  // namespace kinectlab::simulated_rig
