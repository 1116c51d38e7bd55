#include "pipeline/sensor/recording.hpp"

#include <algorithm>

#include "pipeline/core/file_ending.hpp"
#include "pipeline/sensor/oni_recording.hpp"
#include "pipeline/sensor/pcd_sequence.hpp"
#include "pipeline/sensor/read_ahead.hpp"
#include "pipeline/sensor/tum_sequence.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;

bool holds_pcd(const fs::path& folder) {
    std::error_code code;
    const auto is_pcd = [](const fs::directory_entry& entry) {
        return file_ending(entry.path()) == ".pcd";
    };
    return std::any_of(fs::directory_iterator(folder, code), fs::directory_iterator(), is_pcd);
}

// A folder, or one .pcd file.
Result<std::unique_ptr<FrameSource>> open_pictures(
    const fs::path& path, const RecordingOptions& options
) {
    std::error_code code;
    const bool clouds =
        !fs::is_directory(path, code) || (!fs::exists(path / "depth.txt", code) && holds_pcd(path));
    auto source = clouds ? open_pcd_sequence(path) : open_tum_sequence(path, options.with_colour);
    if (source && options.ahead) return read_ahead(std::move(*source));
    return source;
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_recording(
    const fs::path& path, const RecordingOptions& options
) {
    std::error_code code;
    if (!fs::exists(path, code)) {
        return fail(
            ErrorCode::not_found,
            path.string(),
            "is not there",
            "give a recording's folder, a .pcd or an .oni file"
        );
    }
    if (fs::is_directory(path, code) || file_ending(path) == ".pcd")
        return open_pictures(path, options);
    if (file_ending(path) == ".oni") return open_oni(path, options.with_colour);
    return fail(
        ErrorCode::bad_data,
        path.string(),
        "is no recording that can be read",
        "give a folder in the TUM layout, a .pcd or an .oni file"
    );
}

}  // namespace kinectlab
