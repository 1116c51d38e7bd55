#include "pipeline/sensor/openni_device.hpp"

#include <atomic>
#include <cstring>
#include <filesystem>
#include <mutex>

#include <OpenNI.h>

#include "pipeline/sensor/openni_source.hpp"

namespace kinectlab {
namespace {

constexpr int kPreferredWidth = 640;
constexpr int kPreferredHeight = 480;
constexpr int kPreferredFps = 30;

// OpenNI2 is initialised once and never shut down: at the end of a program its threads and ours
// would race with the destructors of static objects. Opening and closing devices takes turns.
std::mutex& openni() {
    static auto* const kMutex = [] {
        const openni::Status status = openni::OpenNI::initialize();
        if (status != openni::STATUS_OK) {
            throw std::runtime_error(
                std::string("OpenNI2 does not start: ") + openni::OpenNI::getExtendedError()
            );
        }
        return new std::mutex;
    }();
    return *kMutex;
}

std::vector<std::string> devices() {
    openni::Array<openni::DeviceInfo> infos;
    openni::OpenNI::enumerateDevices(&infos);
    std::vector<std::string> uris;
    for (int i = 0; i < infos.getSize(); ++i)
        uris.emplace_back(infos[i].getUri());
    return uris;
}

tl::unexpected<Error> no_device(const std::string& uri, std::string why) {
    std::string there;
    for (const auto& other : devices())
        there += (there.empty() ? "" : ", ") + other;
    while (!why.empty() && std::isspace(static_cast<unsigned char>(why.back())) != 0)
        why.pop_back();
    std::error_code code;
    if (std::filesystem::is_regular_file(uri, code))
        return fail(
            ErrorCode::bad_data,
            uri,
            "is no recording that OpenNI2 can play" + (why.empty() ? why : ": " + why),
            "give a whole .oni file; one that was cut off while it was recorded has lost its index"
        );
    return fail(
        ErrorCode::unavailable,
        uri.empty() ? "any device" : uri,
        "cannot be opened: " + (why.empty() ? "its driver does not say why" : why),
        there.empty() ? "plug a device in; none is there" : "devices there: " + there
    );
}

// The largest mode is not the best one: the pipeline is made for 640x480 at 30 Hz.
openni::Status prefer_mode(
    openni::VideoStream& stream, std::initializer_list<openni::PixelFormat> formats
) {
    const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
    for (const auto format : formats) {
        for (int i = 0; i < modes.getSize(); ++i) {
            const auto& mode = modes[i];
            if (mode.getPixelFormat() == format && mode.getResolutionX() == kPreferredWidth &&
                mode.getResolutionY() == kPreferredHeight && mode.getFps() == kPreferredFps) {
                return stream.setVideoMode(mode);
            }
        }
    }
    return openni::STATUS_OK;  // a driver with one mode of its own, or a file
}

// Calls copy(row of `from`, row of `to`) for each row; mirrored rows are turned round.
template <class Pixel>
void copy_rows(const openni::VideoFrameRef& from, bool mirrored, Pixel* to) {
    const auto width = static_cast<std::size_t>(from.getWidth());
    const auto* bytes = static_cast<const std::byte*>(from.getData());
    for (int v = 0; v < from.getHeight(); ++v, to += width, bytes += from.getStrideInBytes()) {
        const auto* row = reinterpret_cast<const Pixel*>(bytes);
        mirrored ? std::reverse_copy(row, row + width, to) : std::copy(row, row + width, to);
    }
}

struct Rgb {
    std::uint8_t r, g, b;
};

}  // namespace

struct OpenniDevice::State : openni::OpenNI::DeviceDisconnectedListener {
    std::string uri;
    std::mutex device_mutex;  // between properties and closing
    openni::Device device;
    openni::VideoStream depth;
    openni::VideoStream colour;
    openni::VideoFrameRef depth_frame;
    openni::VideoFrameRef colour_frame;
    bool depth_mirrored = false;
    bool colour_mirrored = false;
    std::atomic<bool> gone = false;
    OpenniModes modes;

    State() { openni::OpenNI::addDeviceDisconnectedListener(this); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() override {
        openni::OpenNI::removeDeviceDisconnectedListener(this);
        const std::lock_guard turn(openni());
        const std::lock_guard lock(device_mutex);
        depth_frame.release();
        colour_frame.release();
        depth.destroy();
        colour.destroy();
        device.close();
    }

    void onDeviceDisconnected(const openni::DeviceInfo* info) override {
        if (info != nullptr && uri == info->getUri()) gone = true;
    }

    Result<void> start(const std::string& wanted, bool with_colour);
    Result<void> start_depth();
    void start_colour();
    void describe();
};

Result<void> OpenniDevice::State::start(const std::string& wanted, bool with_colour) {
    const auto status = device.open(wanted.empty() ? openni::ANY_DEVICE : wanted.c_str());
    if (status != openni::STATUS_OK) return no_device(wanted, openni::OpenNI::getExtendedError());
    uri = device.getDeviceInfo().getUri();
    const bool is_file = device.isFile();
    if (is_file) {
        // As fast as it is read, every frame once; seeking in a started stream crashes the file
        // driver.
        auto* playback = device.getPlaybackControl();
        playback->setRepeatEnabled(false);
        playback->setSpeed(-1.0F);
    }
    if (auto started = start_depth(); !started) return started;
    if (with_colour && device.hasSensor(openni::SENSOR_COLOR)) start_colour();
    describe();
    if (is_file) {
        modes.recorded_frames = static_cast<std::size_t>(
            std::max(0, device.getPlaybackControl()->getNumberOfFrames(depth))
        );
    }
    if (depth.start() != openni::STATUS_OK)
        return no_device(uri, openni::OpenNI::getExtendedError());
    if (colour.isValid() && colour.start() != openni::STATUS_OK)
        return no_device(uri, openni::OpenNI::getExtendedError());
    return {};
}

Result<void> OpenniDevice::State::start_depth() {
    if (depth.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
        return no_device(
            uri, std::string("it has no depth stream; ") + openni::OpenNI::getExtendedError()
        );
    }
    prefer_mode(depth, {openni::PIXEL_FORMAT_DEPTH_1_MM, openni::PIXEL_FORMAT_DEPTH_100_UM});
    const auto mode = depth.getVideoMode();
    const bool mm = mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM;
    if (!mm && mode.getPixelFormat() != openni::PIXEL_FORMAT_DEPTH_100_UM) {
        return no_device(uri, "its depth is neither in 1 mm nor in 0.1 mm");
    }
    modes.width = mode.getResolutionX();
    modes.height = mode.getResolutionY();
    modes.depth_unit_m = mm ? 0.001 : 0.0001;
    modes.fps = mode.getFps() > 0 ? mode.getFps() : kPreferredFps;
    // Live devices can be told not to mirror; a file's pictures stay as they were recorded.
    depth.setMirroringEnabled(false);
    depth_mirrored = depth.getMirroringEnabled();
    return {};
}

// A colour stream that cannot be read is left out: depth alone still measures.
void OpenniDevice::State::start_colour() {
    if (colour.create(device, openni::SENSOR_COLOR) != openni::STATUS_OK) return;
    prefer_mode(colour, {openni::PIXEL_FORMAT_RGB888});
    const auto mode = colour.getVideoMode();
    if (mode.getPixelFormat() != openni::PIXEL_FORMAT_RGB888) return colour.destroy();
    modes.colour_width = mode.getResolutionX();
    modes.colour_height = mode.getResolutionY();
    colour.setMirroringEnabled(false);
    colour_mirrored = colour.getMirroringEnabled();
}

void OpenniDevice::State::describe() {
    modes.horizontal_fov_rad = depth.getHorizontalFieldOfView();
    if (colour.isValid()) modes.colour_horizontal_fov_rad = colour.getHorizontalFieldOfView();
    const auto& info = device.getDeviceInfo();
    modes.name = std::string(info.getVendor()) + " " + info.getName();
}

Result<std::unique_ptr<OpenniDevice>> OpenniDevice::open(const std::string& uri, bool with_colour) {
    std::mutex& turn = openni();
    auto state = std::make_unique<State>();
    const auto started = [&] {
        const std::lock_guard lock(turn);
        return state->start(uri, with_colour);
    }();
    if (!started) return tl::unexpected<Error>(started.error());
    return std::unique_ptr<OpenniDevice>(new OpenniDevice(std::move(state)));
}

OpenniDevice::OpenniDevice(std::unique_ptr<State> state) : state_(std::move(state)) {}
OpenniDevice::~OpenniDevice() = default;

const OpenniModes& OpenniDevice::modes() const {
    return state_->modes;
}

OpenniDevice::Event OpenniDevice::wait(std::chrono::milliseconds timeout) {
    auto& s = *state_;
    if (s.gone) return Event::gone;
    std::array<openni::VideoStream*, 2> streams = {&s.depth, &s.colour};
    const int count = s.colour.isValid() ? 2 : 1;
    int ready = -1;
    const auto ms = static_cast<int>(std::max<std::chrono::milliseconds::rep>(timeout.count(), 0));
    const auto status = openni::OpenNI::waitForAnyStream(streams.data(), count, &ready, ms);
    if (s.gone) return Event::gone;
    if (status == openni::STATUS_TIME_OUT) return Event::none;
    if (status != openni::STATUS_OK) return Event::gone;
    auto& frame = ready == 0 ? s.depth_frame : s.colour_frame;
    if (streams[static_cast<std::size_t>(ready)]->readFrame(&frame) != openni::STATUS_OK)
        return Event::gone;
    const bool fits = ready == 0
                          ? frame.getWidth() == s.modes.width && frame.getHeight() == s.modes.height
                          : frame.getWidth() == s.modes.colour_width &&
                                frame.getHeight() == s.modes.colour_height;
    if (!fits) return Event::gone;  // the mode was changed by another program
    return ready == 0 ? Event::depth : Event::colour;
}

OpenniStamp OpenniDevice::depth_stamp() const {
    return {
        static_cast<std::uint64_t>(state_->depth_frame.getFrameIndex()),
        state_->depth_frame.getTimestamp()};
}

OpenniStamp OpenniDevice::colour_stamp() const {
    return {
        static_cast<std::uint64_t>(state_->colour_frame.getFrameIndex()),
        state_->colour_frame.getTimestamp()};
}

void OpenniDevice::copy_depth(std::vector<std::uint16_t>& depth) const {
    const auto& modes = state_->modes;
    depth.resize(static_cast<std::size_t>(modes.width) * static_cast<std::size_t>(modes.height));
    copy_rows(state_->depth_frame, state_->depth_mirrored, depth.data());
}

void OpenniDevice::copy_colour(std::vector<std::uint8_t>& rgb) const {
    const auto& modes = state_->modes;
    rgb.resize(
        3 * static_cast<std::size_t>(modes.colour_width) *
        static_cast<std::size_t>(modes.colour_height)
    );
    copy_rows(state_->colour_frame, state_->colour_mirrored, reinterpret_cast<Rgb*>(rgb.data()));
}

bool OpenniDevice::set_property(int id, std::span<const std::byte> data) {
    const std::lock_guard lock(state_->device_mutex);
    if (state_->gone) return false;
    return state_->device.setProperty(id, data.data(), static_cast<int>(data.size())) ==
           openni::STATUS_OK;
}

bool OpenniDevice::get_property(int id, std::span<std::byte> data) {
    const std::lock_guard lock(state_->device_mutex);
    int size = static_cast<int>(data.size());
    if (state_->gone) return false;
    const auto status = state_->device.getProperty(id, data.data(), &size);
    return status == openni::STATUS_OK && static_cast<std::size_t>(size) == data.size();
}

std::vector<std::string> list_openni_devices() {
    const std::lock_guard turn(openni());
    return devices();
}

}  // namespace kinectlab
