#include "pipeline/sensor/oni_recording.hpp"

#include <cmath>
#include <mutex>
#include <set>

#include "pipeline/sensor/openni_camera.hpp"
#include "pipeline/sensor/openni_device.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPatience{3000};  // the driver reads from disk: this is long
constexpr std::string_view kMagic = "NI10";
constexpr int kAttempts = 20;

// The files that are open in this process; a file leaves the list when its source goes.
class OpenFiles {
public:
    static bool enter(const fs::path& file) {
        const std::lock_guard lock(mutex());
        return files().insert(file).second;
    }
    static void leave(const fs::path& file) {
        const std::lock_guard lock(mutex());
        files().erase(file);
    }

private:
    static std::mutex& mutex() {
        static std::mutex mutex;
        return mutex;
    }
    static std::set<fs::path>& files() {
        static std::set<fs::path> files;
        return files;
    }
};

class OniRecording : public FrameSource {
public:
    /// `file` has entered OpenFiles.
    OniRecording(fs::path file, bool with_colour)
        : file_(std::move(file)), with_colour_(with_colour) {}
    ~OniRecording() override {
        device_.reset();
        OpenFiles::leave(file_);
    }

    [[nodiscard]] Result<void> start() {
        if (auto started = rewind(); !started) return started;
        info_ = describe(file_.filename().string(), *device_);
        if (info_.frame_count.value_or(0) > 0) return {};
        return fail(
            ErrorCode::bad_data, file_.string(), "has no depth frames", "give a recording of depth"
        );
    }

    [[nodiscard]] const SourceInfo& info() const override { return info_; }

    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds) override {
        if (delivered_ == *info_.frame_count) return FrameStatus::end;
        // The player does not wait for a slow reader: a frame that was overwritten before it was
        // read is sought again from the start.
        for (int attempt = 0; attempt < kAttempts; ++attempt) {
            if (find_next_depth()) return take(frame);
            if (auto rewound = rewind(); !rewound) return tl::unexpected(rewound.error());
        }
        return fail(
            ErrorCode::bad_data,
            file_.string(),
            "ends after " + std::to_string(delivered_) + " of " +
                std::to_string(*info_.frame_count) + " frames",
            "give the whole file"
        );
    }

private:
    Result<void> rewind() {
        device_.reset();
        has_colour_ = false;
        auto device = OpenniDevice::open(file_.string(), with_colour_);
        if (!device) return tl::unexpected(device.error());
        device_ = std::move(*device);
        return {};
    }

    // Plays on to the frame after the last one that was delivered; the file counts them from 1.
    bool find_next_depth() {
        while (true) {
            const auto event = device_->wait(kPatience);
            if (event == OpenniDevice::Event::colour) {
                has_colour_ = true;
            } else if (event == OpenniDevice::Event::depth) {
                const std::uint64_t number = device_->depth_stamp().index;
                if (number == delivered_ + 1) return true;
                if (number > delivered_ + 1) return false;
            } else {
                return false;
            }
        }
    }

    Result<FrameStatus> take(RgbdFrame& frame) {
        const auto stamp = device_->depth_stamp();
        const TimeNs t = static_cast<TimeNs>(stamp.t_us) * 1000;
        if (delivered_ > 0 && t <= last_t_)
            return fail(
                ErrorCode::bad_data,
                file_.string(),
                "has times that do not increase, at frame " + std::to_string(stamp.index),
                "record it again"
            );
        frame.index = delivered_++;
        frame.t = last_t_ = t;
        device_->copy_depth(frame.depth);
        take_colour(frame);
        return FrameStatus::frame;
    }

    void take_colour(RgbdFrame& frame) const {
        frame.rgb.clear();
        frame.t_colour = 0;
        if (!has_colour_) return;
        const TimeNs t = static_cast<TimeNs>(device_->colour_stamp().t_us) * 1000;
        if (std::abs(t - frame.t) > from_seconds(0.5 / info_.frame_rate_hz)) return;
        device_->copy_colour(frame.rgb);
        frame.t_colour = t;
    }

    fs::path file_;
    bool with_colour_;
    SourceInfo info_;
    std::unique_ptr<OpenniDevice> device_;
    std::size_t delivered_ = 0;
    TimeNs last_t_ = 0;
    bool has_colour_ = false;
};

// The file driver crashes on some files that are none: look at the first bytes before it does.
Result<void> check_magic(const fs::path& file) {
    std::error_code code;
    std::FILE* raw = fs::is_regular_file(file, code) ? std::fopen(file.c_str(), "rb") : nullptr;
    if (raw == nullptr)
        return fail(
            ErrorCode::not_found, file.string(), "cannot be read", "give the path of an .oni file"
        );
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(raw, &std::fclose);
    std::array<char, kMagic.size()> magic{};
    const std::size_t read = std::fread(magic.data(), 1, magic.size(), stream.get());
    if (std::string_view(magic.data(), read) == kMagic) return {};
    return fail(
        ErrorCode::bad_data,
        file.string(),
        "is no .oni recording",
        "give a file that OpenNI2 recorded"
    );
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_oni(const fs::path& file, bool with_colour) {
    if (auto checked = check_magic(file); !checked) return tl::unexpected(checked.error());
    const fs::path whole = fs::canonical(file);
    if (!OpenFiles::enter(whole))
        return fail(
            ErrorCode::conflict, file.string(), "is being read already", "wait until that has ended"
        );
    auto recording = std::make_unique<OniRecording>(whole, with_colour);
    if (auto started = recording->start(); !started) return tl::unexpected(started.error());
    return recording;
}

}  // namespace kinectlab
