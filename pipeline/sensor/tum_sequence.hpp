#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

/// A folder in the TUM RGB-D layout; see open_recording and camera_json.hpp. Without colour its
/// pictures are not decoded, its list is checked all the same.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_tum_sequence(
    const std::filesystem::path& folder, bool with_colour = true
);

struct DamagedPictures {
    std::size_t damaged = 0;
    std::size_t all = 0;
    std::optional<Error> first;  ///< what is wrong with the first of them
};

/// The colour pictures of such a folder that cannot be decoded, found without decoding them: for
/// who reads depth alone, and would not notice. None where there is no colour.
[[nodiscard]] DamagedPictures check_colour_pictures(const std::filesystem::path& folder);

}  // namespace kinectlab
