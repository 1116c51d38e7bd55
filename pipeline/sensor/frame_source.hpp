#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab {

/// What is known about a source before its first frame.
struct SourceInfo {
    std::string name;  ///< for people and provenance, e.g. "sim://rig-1" or a folder's name
    RgbdCamera camera;
    std::optional<Eigen::Isometry3d> T_lab_cam;  ///< where the source itself knows it
    double frame_rate_hz = 30.0;                 ///< nominal
    std::optional<std::size_t> frame_count;      ///< of a recording
};

enum class FrameStatus {
    frame,         ///< The frame was filled.
    timeout,       ///< None arrived in time; ask again.
    disconnected,  ///< The device is gone; the source looks for it at every further call.
    end,           ///< The recording is over.
};

/// Where frames come from. Not thread-safe: one thread owns a source.
class FrameSource {
public:
    FrameSource() = default;
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;
    virtual ~FrameSource() = default;

    [[nodiscard]] virtual const SourceInfo& info() const = 0;

    /// Waits for the next frame and fills it; its buffers are reused, so pass the same frame again.
    /// Times of successive frames increase strictly. A damaged recording is an error that names the
    /// file; a device that vanishes is a status.
    [[nodiscard]] virtual Result<FrameStatus> next(
        RgbdFrame& frame, std::chrono::milliseconds timeout
    ) = 0;

    /// While held, a live device's times go on at its own clock's rate, and do not follow the
    /// computer's: a correction would bend what is measured. Recordings have but one clock.
    virtual void hold_clock(bool held) { static_cast<void>(held); }
};

}  // namespace kinectlab
