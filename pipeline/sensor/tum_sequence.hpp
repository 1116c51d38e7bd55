#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

/// A folder in the TUM RGB-D layout; see open_recording and camera_json.hpp. Without colour its
/// pictures are not decoded, its list is checked all the same.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_tum_sequence(
    const std::filesystem::path& folder, bool with_colour = true
);

}  // namespace kinectlab
