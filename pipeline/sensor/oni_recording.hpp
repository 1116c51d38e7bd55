#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

/// An .oni file through OpenNI2's own file driver, as fast as it is read, unmirrored, depth and
/// colour within half a period paired. Its times count from the start of the recording. OpenNI2
/// gives everybody who opens the same file the same player, so a second source of one file at a
/// time is refused. That driver is not made for hostile files: open only what people of the
/// laboratory recorded.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_oni(
    const std::filesystem::path& file, bool with_colour = true
);

}  // namespace kinectlab
