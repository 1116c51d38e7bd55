#pragma once

#include <mutex>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/drivers/simulated_rig/openni_driver.hpp"

namespace kinectlab::simulated_rig {

/// The one video mode that each sensor has: 640x480 at 30 Hz, millimetres or RGB888.
[[nodiscard]] OniVideoMode video_mode(OniSensorType sensor);

/// The depth or the colour stream of a device. start() and stop() come from the program's threads,
/// deliver() from the rig's; once stop() has returned nothing more is delivered.
class Stream : public oni::driver::StreamBase {
public:
    Stream(OniSensorType sensor, const RgbdCamera& camera);

    OniStatus start() override;
    void stop() override;
    OniStatus getProperty(int id, void* data, int* size) override;
    OniStatus setProperty(int id, const void* data, int size) override;
    OniBool isPropertySupported(int id) override;
    OniStatus convertDepthToColorCoordinates(
        oni::driver::StreamBase* colour,
        int u,
        int v,
        OniDepthPixel depth,
        int* colour_u,
        int* colour_v
    ) override;

    [[nodiscard]] bool running() const;
    void deliver(const RgbdFrame& frame);

private:
    [[nodiscard]] const Pinhole& pinhole() const;

    const OniSensorType sensor_;
    const RgbdCamera camera_;
    mutable std::mutex mutex_;
    bool running_ = false;
};

}  // namespace kinectlab::simulated_rig
