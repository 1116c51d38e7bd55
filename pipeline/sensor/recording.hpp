#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

struct RecordingOptions {
    bool with_colour = true;  ///< false leaves RgbdFrame::rgb empty, where that saves decoding it
    /// Frames are decoded ahead by a second thread (read_ahead.hpp), for who goes through many. Not
    /// those of an .oni file: its player has a thread already.
    bool ahead = false;
};

/// Opens whatever a recording may be: a folder in the TUM RGB-D layout (depth.txt, rgb.txt, depth/,
/// rgb/, camera.json), one organised .pcd file or a folder of them, or an .oni file.
/// Everything that can be checked without decoding a picture is checked here: the lists, that every
/// file they name is there, that timestamps increase. Decoding errors come from next().
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_recording(
    const std::filesystem::path& path, const RecordingOptions& options = {}
);

}  // namespace kinectlab
