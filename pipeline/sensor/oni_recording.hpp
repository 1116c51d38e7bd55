#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

/// An .oni file through OpenNI2's own file driver, as fast as it is read, unmirrored, depth and
/// colour within half a period paired. Its times count from the start of the recording. That driver
/// is not made for hostile files: open only what people of the laboratory recorded.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_oni(const std::filesystem::path& file);

}  // namespace kinectlab
