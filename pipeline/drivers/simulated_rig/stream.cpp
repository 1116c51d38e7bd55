#include "pipeline/drivers/simulated_rig/stream.hpp"

#include <cmath>
#include <cstring>

#include "pipeline/drivers/simulated_rig/properties.hpp"

namespace kinectlab::simulated_rig {
namespace {

constexpr int kFramesPerSecond = 30;
constexpr int kFarthestMm = 10000;

float field_of_view(int pixels, double focal_px) {
    return static_cast<float>(2.0 * std::atan(0.5 * pixels / focal_px));
}

/// Microseconds from the rig's start to the frame's capture.
std::uint64_t device_time_us(std::uint64_t index) {
    return (index * 1'000'000 + kFramesPerSecond / 2) / kFramesPerSecond;
}

/// A program may set what is so already, and nothing else.
template <class T>
OniStatus accept_only(const T& present, const void* data, int size) {
    T wanted{};
    if (!take(wanted, data, size)) return ONI_STATUS_BAD_PARAMETER;
    return std::memcmp(&wanted, &present, sizeof(T)) == 0 ? ONI_STATUS_OK
                                                          : ONI_STATUS_NOT_SUPPORTED;
}

}  // namespace

OniVideoMode video_mode(OniSensorType sensor) {
    const bool depth = sensor == ONI_SENSOR_DEPTH;
    return {
        depth ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888, 640, 480, kFramesPerSecond};
}

Stream::Stream(OniSensorType sensor, const RgbdCamera& camera) : sensor_(sensor), camera_(camera) {}

OniStatus Stream::start() {
    const std::lock_guard lock(mutex_);
    running_ = true;
    return ONI_STATUS_OK;
}

void Stream::stop() {
    const std::lock_guard lock(mutex_);
    running_ = false;
}

bool Stream::running() const {
    const std::lock_guard lock(mutex_);
    return running_;
}

OniStatus Stream::getProperty(int id, void* data, int* size) {
    const bool depth = sensor_ == ONI_SENSOR_DEPTH;
    const Pinhole& camera = pinhole();
    switch (id) {
        case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
            return give(field_of_view(camera.width, camera.fx), data, size);
        case ONI_STREAM_PROPERTY_VERTICAL_FOV:
            return give(field_of_view(camera.height, camera.fy), data, size);
        case ONI_STREAM_PROPERTY_VIDEO_MODE:
            return give(video_mode(sensor_), data, size);
        case ONI_STREAM_PROPERTY_MAX_VALUE:
            return give(depth ? kFarthestMm : 255, data, size);
        case ONI_STREAM_PROPERTY_MIN_VALUE:
            return give(0, data, size);
        case ONI_STREAM_PROPERTY_STRIDE:
            return give(camera.width * (depth ? 2 : 3), data, size);
        case ONI_STREAM_PROPERTY_MIRRORING:
            return give(OniBool{FALSE}, data, size);
        default:
            return ONI_STATUS_NOT_SUPPORTED;
    }
}

OniStatus Stream::setProperty(int id, const void* data, int size) {
    if (id == ONI_STREAM_PROPERTY_VIDEO_MODE) return accept_only(video_mode(sensor_), data, size);
    if (id == ONI_STREAM_PROPERTY_MIRRORING) return accept_only(OniBool{FALSE}, data, size);
    return ONI_STATUS_NOT_SUPPORTED;
}

OniBool Stream::isPropertySupported(int id) {
    return id >= ONI_STREAM_PROPERTY_HORIZONTAL_FOV && id <= ONI_STREAM_PROPERTY_MIRRORING;
}

OniStatus Stream::convertDepthToColorCoordinates(
    oni::driver::StreamBase* /*colour*/,
    int u,
    int v,
    OniDepthPixel depth,
    int* colour_u,
    int* colour_v
) {
    if (sensor_ != ONI_SENSOR_DEPTH || depth == 0) return ONI_STATUS_BAD_PARAMETER;
    const Eigen::Vector3d p_cam = depth * camera_.depth_unit_m * camera_.depth.ray(u, v);
    const Eigen::Vector2d pixel = camera_.colour.project(camera_.T_colour_depth * p_cam);
    *colour_u = static_cast<int>(std::lround(pixel.x()));
    *colour_v = static_cast<int>(std::lround(pixel.y()));
    return ONI_STATUS_OK;
}

void Stream::deliver(const RgbdFrame& frame) {
    const std::lock_guard lock(mutex_);
    const bool depth = sensor_ == ONI_SENSOR_DEPTH;
    const void* pixels = depth ? static_cast<const void*>(frame.depth.data()) : frame.rgb.data();
    const std::size_t bytes = depth ? frame.depth.size() * 2 : frame.rgb.size();
    if (!running_ || bytes == 0) return;
    OniFrame* out = getServices().acquireFrame();
    if (out == nullptr || static_cast<std::size_t>(out->dataSize) < bytes) return;
    std::memcpy(out->data, pixels, bytes);
    out->dataSize = static_cast<int>(bytes);
    out->sensorType = sensor_;
    out->timestamp = device_time_us(frame.index);
    out->frameIndex = static_cast<int>(frame.index);
    out->videoMode = video_mode(sensor_);
    out->width = out->videoMode.resolutionX;
    out->height = out->videoMode.resolutionY;
    out->croppingEnabled = FALSE;
    out->cropOriginX = out->cropOriginY = 0;
    out->stride = out->width * (depth ? 2 : 3);
    raiseNewFrame(out);
    getServices().releaseFrame(out);
}

const Pinhole& Stream::pinhole() const {
    return sensor_ == ONI_SENSOR_DEPTH ? camera_.depth : camera_.colour;
}

}  // namespace kinectlab::simulated_rig
