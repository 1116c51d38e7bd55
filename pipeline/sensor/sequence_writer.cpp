#include "pipeline/sensor/sequence_writer.hpp"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "pipeline/sensor/camera_json.hpp"
#include "pipeline/sensor/file_bytes.hpp"
#include "pipeline/sensor/png_image.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kQueue = 4;  // frames waiting: enough to keep both encoders busy
constexpr int kEncoders = 2;

void write_text(const fs::path& file, const std::string& text) {
    write_file(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// Frames go in on one side, files come out on the other; the first failure is kept for the owner.
class Encoders {
public:
    Encoders(fs::path folder, const RgbdCamera& camera)
        : folder_(std::move(folder)), camera_(camera) {
        for (auto& thread : threads_)
            thread = std::thread([this] { work(); });
    }
    Encoders(const Encoders&) = delete;
    Encoders& operator=(const Encoders&) = delete;
    ~Encoders() { stop(); }

    void put(RgbdFrame frame) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return queue_.size() < kQueue || failure_; });
        if (failure_) std::rethrow_exception(failure_);
        queue_.push_back(std::move(frame));
        changed_.notify_all();
    }

    void finish() {
        stop();
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    void stop() {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        changed_.notify_all();
        for (auto& thread : threads_) {
            if (thread.joinable()) thread.join();
        }
    }

    void work() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return !queue_.empty() || over_; });
            if (queue_.empty()) return;
            RgbdFrame frame = std::move(queue_.front());
            queue_.pop_front();
            lock.unlock();
            changed_.notify_all();
            std::exception_ptr failure;
            try {
                write(frame);
            } catch (...) {
                failure = std::current_exception();
            }
            lock.lock();
            if (failure && !failure_) failure_ = failure;
        }
    }

    void write(RgbdFrame& frame) const {
        const std::string name = format_timestamp(frame.t) + ".png";
        const double to_mm = camera_.depth_unit_m * 1000.0;
        if (to_mm != 1.0) {
            for (auto& d : frame.depth)
                d = static_cast<std::uint16_t>(std::min(65535.0, d * to_mm + 0.5));
        }
        const PngSize size{camera_.depth.width, camera_.depth.height};
        write_file(
            folder_ / "depth" / name, encode_png(std::span<const std::uint16_t>(frame.depth), size)
        );
        if (frame.rgb.empty()) return;
        const PngSize colour_size{camera_.colour.width, camera_.colour.height};
        const std::string colour_name = format_timestamp(frame.t_colour) + ".png";
        write_file(
            folder_ / "rgb" / colour_name,
            encode_png(std::span<const std::uint8_t>(frame.rgb), colour_size)
        );
    }

    fs::path folder_;
    RgbdCamera camera_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<RgbdFrame> queue_;
    bool over_ = false;
    std::exception_ptr failure_;
    std::array<std::thread, kEncoders> threads_;
};

CameraFile camera_file(const SourceInfo& source) {
    CameraFile file;
    file.camera = source.camera;
    file.camera.depth_unit_m = 0.001;
    file.has_size = file.has_colour = file.has_colour_size = true;
    file.T_lab_cam = source.T_lab_cam;
    file.frame_rate_hz = source.frame_rate_hz;
    return file;
}

std::string truth_line(const TumPose& pose) {
    std::array<char, 256> line{};
    const auto& [t, p, q] = pose;
    std::snprintf(
        line.data(),
        line.size(),
        "%s %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n",
        format_timestamp(t).c_str(),
        p.x(),
        p.y(),
        p.z(),
        q.x(),
        q.y(),
        q.z(),
        q.w()
    );
    return line.data();
}

}  // namespace

struct SequenceWriter::State {
    fs::path folder;
    fs::path partial;
    RgbdCamera camera;
    TimeNs last_t = -1;
    TimeNs last_t_colour = -1;
    std::string depth_list = "# timestamp path\n";
    std::string rgb_list = "# timestamp path\n";
    std::map<std::string, std::string> truths;  ///< by file
    std::unique_ptr<Encoders> encoders;

    ~State() {
        encoders.reset();
        std::error_code ignored;
        if (!partial.empty()) fs::remove_all(partial, ignored);
    }
};

Result<SequenceWriter> SequenceWriter::create(const fs::path& folder, const SourceInfo& source) {
    std::error_code code;
    const bool there = fs::exists(folder, code);
    if (there && (!fs::is_directory(folder, code) || !fs::is_empty(folder, code))) {
        return fail(
            ErrorCode::conflict,
            folder.string(),
            "is there already and not an empty folder",
            "name a new folder"
        );
    }
    auto state = std::make_unique<State>();
    state->folder = fs::absolute(folder).lexically_normal();
    if (!state->folder.has_filename()) state->folder = state->folder.parent_path();
    if (!fs::is_directory(state->folder.parent_path(), code)) {
        return fail(
            ErrorCode::not_found,
            folder.string(),
            "lies in a folder that is not there",
            "make the folder " + state->folder.parent_path().string() + " first"
        );
    }
    fs::path partial = state->folder;
    partial += ".partial";
    if (!fs::create_directory(partial, code)) {
        return fail(
            ErrorCode::conflict,
            partial.string(),
            code ? code.message()
                 : "is there already: another program writes it, or was killed while it did",
            code ? "name a folder that you may write" : "remove it if nobody writes it"
        );
    }
    state->partial = partial;
    fs::create_directory(partial / "depth");
    fs::create_directory(partial / "rgb");
    state->camera = source.camera;
    write_camera_json(partial / "camera.json", camera_file(source));
    state->encoders = std::make_unique<Encoders>(partial, source.camera);
    return SequenceWriter(std::move(state));
}

SequenceWriter::SequenceWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
SequenceWriter::SequenceWriter(SequenceWriter&&) noexcept = default;
SequenceWriter& SequenceWriter::operator=(SequenceWriter&&) noexcept = default;
SequenceWriter::~SequenceWriter() = default;

Result<void> SequenceWriter::add(const RgbdFrame& frame) {
    auto& s = *state_;
    const auto pixels = [](const Pinhole& p) {
        return static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height);
    };
    const bool fits = frame.depth.size() == pixels(s.camera.depth) &&
                      (frame.rgb.empty() || frame.rgb.size() == 3 * pixels(s.camera.colour));
    if (!fits)
        return fail(
            ErrorCode::invalid_argument,
            "frame",
            "has another size than the camera",
            "give the camera's frames"
        );
    if (frame.t <= s.last_t) {
        return fail(
            ErrorCode::invalid_argument,
            "frame",
            "is not later than the one before",
            "give times that increase"
        );
    }
    s.last_t = frame.t;
    s.depth_list += format_timestamp(frame.t) + " depth/" + format_timestamp(frame.t) + ".png\n";
    RgbdFrame copy = frame;
    if (!frame.rgb.empty() && frame.t_colour > s.last_t_colour) {
        s.last_t_colour = frame.t_colour;
        s.rgb_list += format_timestamp(frame.t_colour) + " rgb/" +
                      format_timestamp(frame.t_colour) + ".png\n";
    } else {
        copy.rgb.clear();  // two depth pictures may share a colour picture, which is written once
    }
    s.encoders->put(std::move(copy));
    return {};
}

void SequenceWriter::add_truth(const TumPose& pose) {
    state_->truths["groundtruth.txt"] += truth_line(pose);
}

void SequenceWriter::add_truth_of(const std::string& name, const TumPose& pose) {
    state_->truths["groundtruth_" + name + ".txt"] += truth_line(pose);
}

void SequenceWriter::add_file(const std::string& name, const std::string& content) {
    write_text(state_->partial / name, content);
}

void SequenceWriter::finish() {
    auto& s = *state_;
    s.encoders->finish();
    for (const auto& [file, lines] : s.truths)
        write_text(s.partial / file, "# timestamp tx ty tz qx qy qz qw\n" + lines);
    if (s.last_t_colour >= 0) {
        write_text(s.partial / "rgb.txt", s.rgb_list);
    } else {
        fs::remove(s.partial / "rgb");  // a recording without colour has neither list nor folder
    }
    write_text(s.partial / "depth.txt", s.depth_list);
    fs::rename(s.partial, s.folder);  // takes the place of an empty folder
    s.partial.clear();
}

}  // namespace kinectlab
