#include "pipeline/sensor/oni_recording.hpp"

#include <cmath>

#include "pipeline/sensor/file_bytes.hpp"
#include "pipeline/sensor/openni_camera.hpp"
#include "pipeline/sensor/openni_device.hpp"

namespace kinectlab {
namespace {

constexpr std::chrono::milliseconds kPatience{
    5000};  // the file driver reads from disk: a second is long
constexpr std::string_view kMagic = "NI10";

class OniRecording : public FrameSource {
public:
    OniRecording(std::string name, SourceInfo info, std::unique_ptr<OpenniDevice> device)
        : name_(std::move(name)), info_(std::move(info)), device_(std::move(device)) {}

    [[nodiscard]] const SourceInfo& info() const override { return info_; }

    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds) override {
        const std::size_t count = *info_.frame_count;
        if (delivered_ == count) return FrameStatus::end;
        while (true) {
            const auto event = device_->wait(kPatience);
            if (event == OpenniDevice::Event::colour) {
                has_colour_ = true;
                continue;
            }
            if (event != OpenniDevice::Event::depth) {
                return fail(
                    ErrorCode::bad_data,
                    name_,
                    "ends after " + std::to_string(delivered_) + " of " + std::to_string(count) +
                        " frames",
                    "give the whole file"
                );
            }
            const auto stamp = device_->depth_stamp();
            const TimeNs t = static_cast<TimeNs>(stamp.t_us) * 1000;
            if (delivered_ > 0 && t <= last_t_) {
                return fail(
                    ErrorCode::bad_data, name_, "has times that do not increase", "record it again"
                );
            }
            frame.index = stamp.index;
            frame.t = last_t_ = t;
            device_->copy_depth(frame.depth);
            take_colour(frame);
            ++delivered_;
            return FrameStatus::frame;
        }
    }

private:
    void take_colour(RgbdFrame& frame) const {
        frame.rgb.clear();
        frame.t_colour = 0;
        if (!has_colour_) return;
        const TimeNs t = static_cast<TimeNs>(device_->colour_stamp().t_us) * 1000;
        if (std::abs(t - frame.t) > from_seconds(0.5 / info_.frame_rate_hz)) return;
        device_->copy_colour(frame.rgb);
        frame.t_colour = t;
    }

    std::string name_;
    SourceInfo info_;
    std::unique_ptr<OpenniDevice> device_;
    std::size_t delivered_ = 0;
    TimeNs last_t_ = 0;
    bool has_colour_ = false;
};

// The file driver crashes on some files that are none: look at the first bytes before it does.
Result<void> check_magic(const std::filesystem::path& file) {
    std::error_code code;
    std::FILE* raw =
        std::filesystem::is_regular_file(file, code) ? std::fopen(file.c_str(), "rb") : nullptr;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(raw, &std::fclose);
    std::array<char, 4> magic{};
    if (!stream)
        return fail(
            ErrorCode::not_found, file.string(), "cannot be read", "give the path of an .oni file"
        );
    const std::size_t read = std::fread(magic.data(), 1, magic.size(), stream.get());
    if (read == magic.size() && std::string_view(magic.data(), 4) == kMagic) return {};
    return fail(
        ErrorCode::bad_data,
        file.string(),
        "is no .oni recording",
        "give a file that OpenNI2 recorded"
    );
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_oni(const std::filesystem::path& file) {
    if (auto checked = check_magic(file); !checked) return tl::unexpected<Error>(checked.error());
    auto device = OpenniDevice::open(file.string(), true);
    if (!device) return tl::unexpected<Error>(device.error());
    if ((*device)->modes().recorded_frames.value_or(0) == 0) {
        return fail(
            ErrorCode::bad_data, file.string(), "has no depth frames", "give a recording with depth"
        );
    }
    SourceInfo info = describe(file.filename().string(), **device);
    return std::make_unique<OniRecording>(file.string(), std::move(info), std::move(*device));
}

}  // namespace kinectlab
