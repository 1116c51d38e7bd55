#include "pipeline/sensor/tum_sequence.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/core/number_text.hpp"
#include "pipeline/sensor/camera_json.hpp"
#include "pipeline/sensor/file_bytes.hpp"
#include "pipeline/sensor/png_image.hpp"
#include "pipeline/sensor/tum_lists.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPictureBytes = 64U << 20U;

std::string text_of(PngSize size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

Result<PngSize> size_of_picture(const fs::path& file, PngKind kind) {
    std::vector<std::uint8_t> bytes;
    if (auto read = read_file(file, kMaxPictureBytes, bytes); !read)
        return tl::unexpected<Error>(read.error());
    return read_png_size(bytes, kind, file.string());
}

// Without width and height in camera.json only the principal point tells whether the picture is the
// camera's: it lies near the middle in every real one.
Result<void> fit_size(Pinhole& pinhole, bool has_size, PngSize size, const fs::path& file) {
    const PngSize expected{pinhole.width, pinhole.height};
    if (has_size && size != expected) {
        return fail(
            ErrorCode::bad_data,
            file.string(),
            "is " + text_of(size) + ", but the camera's pictures are " + text_of(expected),
            "give pictures of the camera's size, or width and height in camera.json"
        );
    }
    pinhole.width = size.width;
    pinhole.height = size.height;
    const bool central = std::abs(pinhole.cx - 0.5 * (size.width - 1)) < 0.25 * size.width &&
                         std::abs(pinhole.cy - 0.5 * (size.height - 1)) < 0.25 * size.height;
    if (!has_size && !central) {
        return fail(
            ErrorCode::bad_data,
            file.string(),
            "is " + text_of(size) + ", which does not fit the camera: its centre is at cx " +
                number_text(pinhole.cx) + ", cy " + number_text(pinhole.cy),
            "give pictures of the camera's size, or width and height in camera.json"
        );
    }
    return {};
}

class TumSequence : public FrameSource {
public:
    TumSequence(SourceInfo info, std::vector<TumEntry> depth, std::vector<TumEntry> colour)
        : info_(std::move(info)),
          depth_(std::move(depth)),
          colour_(std::move(colour)),
          pairs_(pair_by_time(depth_, colour_)) {}

    [[nodiscard]] const SourceInfo& info() const override { return info_; }

    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds) override {
        if (position_ == depth_.size()) return FrameStatus::end;
        const TumEntry& entry = depth_[position_];
        auto read = read_picture(entry.file, PngKind::depth16, info_.camera.depth, frame.depth, 1);
        frame.rgb.clear();
        frame.t_colour = 0;
        if (const auto pair = pairs_[position_]; read && pair) {
            const TumEntry& colour = colour_[*pair];
            frame.t_colour = colour.t;
            read = read_picture(colour.file, PngKind::rgb8, info_.camera.colour, frame.rgb, 3);
        }
        if (!read) return tl::unexpected<Error>(read.error());
        frame.index = position_++;
        frame.t = entry.t;
        return FrameStatus::frame;
    }

private:
    template <class Pixel>
    Result<void> read_picture(
        const fs::path& file,
        PngKind kind,
        const Pinhole& pinhole,
        std::vector<Pixel>& pixels,
        std::size_t channels
    ) {
        if (auto read = read_file(file, kMaxPictureBytes, bytes_); !read) return read;
        const auto size = read_png_size(bytes_, kind, file.string());
        if (!size) return tl::unexpected<Error>(size.error());
        const PngSize expected{pinhole.width, pinhole.height};
        if (*size != expected) {
            return fail(
                ErrorCode::bad_data,
                file.string(),
                "is " + text_of(*size) + ", but the pictures before it are " + text_of(expected),
                "give pictures of one size"
            );
        }
        pixels.resize(
            static_cast<std::size_t>(size->width) * static_cast<std::size_t>(size->height) *
            channels
        );
        return decode_png(bytes_, std::span<Pixel>(pixels), file.string());
    }

    SourceInfo info_;
    std::vector<TumEntry> depth_;
    std::vector<TumEntry> colour_;
    std::vector<std::optional<std::size_t>> pairs_;
    std::size_t position_ = 0;
    std::vector<std::uint8_t> bytes_;
};

Result<CameraFile> camera_of(const fs::path& folder) {
    std::error_code code;
    const fs::path file = folder / "camera.json";
    return fs::exists(file, code) ? read_camera_json(file) : Result<CameraFile>(default_camera());
}

// Depth alone is a recording too; a folder of colour pictures without their list is a damaged one.
Result<std::vector<TumEntry>> colour_list_of(const fs::path& folder) {
    std::error_code code;
    const bool without = !fs::exists(folder / "rgb.txt", code) && !fs::exists(folder / "rgb", code);
    return without ? Result<std::vector<TumEntry>>() : read_tum_list(folder, "rgb.txt");
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_tum_sequence(const fs::path& folder, bool with_colour) {
    const auto forward = [](const auto& failed) {
        return tl::unexpected<Error>(failed.error());
    };
    auto file = camera_of(folder);
    if (!file) return forward(file);
    auto depth = read_tum_list(folder, "depth.txt");
    if (!depth) return forward(depth);
    auto colour = colour_list_of(folder);
    if (!colour) return forward(colour);

    auto& camera = file->camera;
    const auto depth_size = size_of_picture(depth->front().file, PngKind::depth16);
    if (!depth_size) return forward(depth_size);
    if (auto fits = fit_size(camera.depth, file->has_size, *depth_size, depth->front().file); !fits)
        return forward(fits);
    if (!file->has_colour) camera.colour = camera.depth;  // registered: one camera, one size
    if (!colour->empty()) {
        const fs::path& first = colour->front().file;
        const bool size_known = !file->has_colour || file->has_colour_size;
        const auto size = size_of_picture(first, PngKind::rgb8);
        if (!size) return forward(size);
        if (auto fits = fit_size(camera.colour, size_known, *size, first); !fits)
            return forward(fits);
    }

    if (!with_colour) colour->clear();

    SourceInfo info;
    info.name = fs::absolute(folder).lexically_normal().filename().string();
    if (info.name.empty())
        info.name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
    info.camera = camera;
    info.T_lab_cam = file->T_lab_cam;
    info.frame_count = depth->size();
    const TimeNs step = median_step(*depth);
    if (step > 0) info.frame_rate_hz = 1e9 / static_cast<double>(step);
    if (file->frame_rate_hz) info.frame_rate_hz = *file->frame_rate_hz;
    return std::make_unique<TumSequence>(std::move(info), std::move(*depth), std::move(*colour));
}

DamagedPictures check_colour_pictures(const fs::path& folder) {
    DamagedPictures found;
    const auto list = colour_list_of(folder);
    if (!list) return found;  // whoever opens the folder is told
    std::vector<std::uint8_t> bytes;
    for (const auto& entry : *list) {
        ++found.all;
        const std::string name = entry.file.string();
        const auto whole = read_file(entry.file, kMaxPictureBytes, bytes)
                               .and_then([&] { return read_png_size(bytes, PngKind::rgb8, name); })
                               .and_then([&](PngSize) { return check_png(bytes, name); });
        if (whole) continue;
        ++found.damaged;
        if (!found.first) found.first = whole.error();
    }
    return found;
}

}  // namespace kinectlab
