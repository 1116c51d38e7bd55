#include "pipeline/sensor/openni_source.hpp"

#include <cmath>
#include <mutex>
#include <thread>

#include "pipeline/drivers/simulated_rig/protocol.hpp"
#include "pipeline/sensor/clock_map.hpp"
#include "pipeline/sensor/openni_camera.hpp"
#include "pipeline/sensor/openni_device.hpp"

namespace kinectlab {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kSilence{2000};  // without a depth picture: the device hangs
constexpr milliseconds kRetry{500};     // between two attempts to open it again

TimeNs utc_now() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

milliseconds until(Clock::time_point then) {
    return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(then - Clock::now()));
}

class Source final : public OpenniSource {
public:
    Source(OpenniSettings settings, std::unique_ptr<OpenniDevice> device)
        : settings_(std::move(settings)), device_(std::move(device)), last_depth_(Clock::now()) {
        info_ = describe(settings_.uri, *device_);
        half_period_ = from_seconds(0.5 / info_.frame_rate_hz);
    }

    [[nodiscard]] const SourceInfo& info() const override { return info_; }

    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, milliseconds timeout) override {
        const auto deadline = Clock::now() + timeout;
        if (!device_ && !reopen(deadline)) return FrameStatus::disconnected;
        while (true) {
            if (waiting_ && try_to_complete()) return deliver(frame);
            const auto wake = waiting_ ? std::min(deadline, give_up_colour_) : deadline;
            switch (device_->wait(until(wake))) {
                case OpenniDevice::Event::depth:
                    if (waiting_) {  // the colour picture of the last one never came
                        const auto status = deliver(frame);
                        take_depth();
                        return status;
                    }
                    take_depth();
                    break;
                case OpenniDevice::Event::colour:
                    has_colour_ = true;
                    break;
                case OpenniDevice::Event::gone:
                    close();
                    return FrameStatus::disconnected;
                case OpenniDevice::Event::none:
                    if (Clock::now() - last_depth_ > kSilence) {
                        close();
                        return FrameStatus::disconnected;
                    }
                    if (Clock::now() >= deadline && !waiting_) {
                        return silent_ ? FrameStatus::disconnected : FrameStatus::timeout;
                    }
                    break;
            }
        }
    }

    [[nodiscard]] bool set_property(int id, std::span<const std::byte> data) override {
        const std::lock_guard lock(device_mutex_);
        return device_ && device_->set_property(id, data);
    }

    [[nodiscard]] bool get_property(int id, std::span<std::byte> data) override {
        const std::lock_guard lock(device_mutex_);
        return device_ && device_->get_property(id, data);
    }

    void hold_clock(bool held) override {
        clock_held_ = held;
        clock_.hold(held);
    }

    std::optional<TimeNs> utc_of(double device_s) const override {
        if (!clock_.is_set() || !(device_s >= 0.0)) return std::nullopt;
        return clock_.peek(static_cast<std::uint64_t>(std::llround(1e6 * device_s)));
    }

private:
    void take_depth() {
        const auto stamp = device_->depth_stamp();
        // A picture that is not newer than the last one is a driver's hiccup; the counter shows the
        // gap.
        if (last_device_us_ && stamp.t_us <= *last_device_us_) return;
        last_device_us_ = stamp.t_us;
        last_depth_ = Clock::now();
        pending_stamp_us_ = stamp.t_us;
        pending_.t = clock_.map(stamp.t_us, utc_now());
        if (!index_base_) {
            // After a disconnection the device counts from the start again: what was missed shows
            // as a gap.
            const auto missed =
                last_t_ > 0 ? std::llround(to_seconds(pending_.t - last_t_) * info_.frame_rate_hz)
                            : 0;
            index_base_ = static_cast<std::int64_t>(last_index_) +
                          std::max<std::int64_t>(missed, 0) -
                          static_cast<std::int64_t>(stamp.index);
            if (last_t_ == 0) index_base_ = 0;
        }
        pending_.index =
            static_cast<std::uint64_t>(*index_base_ + static_cast<std::int64_t>(stamp.index));
        device_->copy_depth(pending_.depth);
        pending_.rgb.clear();
        pending_.t_colour = 0;
        waiting_ = true;
        give_up_colour_ = last_depth_ + std::chrono::nanoseconds(half_period_);
        silent_ = false;
    }

    // True if the waiting depth picture can go: with its colour picture, or without because none is
    // coming.
    bool try_to_complete() {
        if (device_->modes().colour_width == 0) return true;
        if (has_colour_) {
            const auto colour_us = static_cast<std::int64_t>(device_->colour_stamp().t_us);
            const std::int64_t apart =
                (colour_us - static_cast<std::int64_t>(pending_stamp_us_)) * 1000;
            if (std::abs(apart) <= half_period_) {
                device_->copy_colour(pending_.rgb);
                pending_.t_colour = clock_.peek(device_->colour_stamp().t_us);
                return true;
            }
            if (apart > 0) return true;  // already the next one
        }
        return Clock::now() >= give_up_colour_;
    }

    FrameStatus deliver(RgbdFrame& frame) {
        std::swap(frame, pending_);
        last_t_ = frame.t;
        last_index_ = frame.index;
        waiting_ = false;
        return FrameStatus::frame;
    }

    void close() {
        const std::lock_guard lock(device_mutex_);
        device_.reset();
        waiting_ = has_colour_ = false;
        silent_ = true;
        next_attempt_ = Clock::now();
    }

    // Tries at most every half second; false if there is still no device at the deadline.
    bool reopen(Clock::time_point deadline) {
        while (true) {
            std::this_thread::sleep_until(std::min(deadline, next_attempt_));
            if (Clock::now() < next_attempt_) return false;
            next_attempt_ = Clock::now() + kRetry;
            auto opened = OpenniDevice::open(settings_.uri, settings_.with_colour);
            if (!opened) {
                if (Clock::now() >= deadline) return false;
                continue;
            }
            clock_ = ClockMap(last_t_);
            clock_.hold(clock_held_);
            index_base_.reset();
            last_device_us_.reset();
            last_depth_ = Clock::now();
            const std::lock_guard lock(device_mutex_);
            device_ = std::move(*opened);
            return true;
        }
    }

    OpenniSettings settings_;
    std::mutex device_mutex_;  ///< properties from other threads against closing and opening
    std::unique_ptr<OpenniDevice> device_;
    SourceInfo info_;
    TimeNs half_period_ = 0;

    ClockMap clock_;
    bool clock_held_ = false;
    RgbdFrame pending_;  ///< a depth picture that waits for its colour picture
    std::uint64_t pending_stamp_us_ = 0;
    bool waiting_ = false;
    Clock::time_point give_up_colour_;
    bool has_colour_ = false;
    std::optional<std::uint64_t> last_device_us_;
    std::optional<std::int64_t> index_base_;
    TimeNs last_t_ = 0;
    std::uint64_t last_index_ = 0;

    Clock::time_point last_depth_;
    Clock::time_point next_attempt_;
    bool silent_ = false;  ///< opened again, but no picture has come yet
};

}  // namespace

Result<std::unique_ptr<OpenniSource>> OpenniSource::open(const OpenniSettings& settings) {
    auto device = OpenniDevice::open(settings.uri, settings.with_colour);
    if (!device) return tl::unexpected<Error>(device.error());
    return std::make_unique<Source>(settings, std::move(*device));
}

}  // namespace kinectlab
