#include "pipeline/drivers/simulated_rig/rig_clock.hpp"

#include <algorithm>
#include <utility>

namespace kinectlab::simulated_rig {
namespace {

constexpr std::uint64_t kMostFramesBehind = 5;

double time_of(std::uint64_t frame) {
    return static_cast<double>(frame) / simulate::kFrameRateHz;
}

}  // namespace

RigClock::RigClock(simulate::RigSettings settings, Watched watched, Deliver deliver)
    : watched_(std::move(watched)),
      deliver_(std::move(deliver)),
      settings_(settings),
      rig_(std::move(*simulate::SimulatedRig::create(settings))) {
    camera_ = rig_.camera();
    T_lab_cam_ = rig_.T_lab_cam();
    seen_.truth = rig_.truth();
    thread_ = std::thread([this] { run(); });
}

RigClock::~RigClock() {
    {
        const std::lock_guard lock(state_mutex_);
        stopping_ = true;
    }
    stopping_changed_.notify_all();
    thread_.join();
}

Result<void> RigClock::set_apparatus(const simulate::ApparatusSettings& apparatus) {
    simulate::RigSettings settings;
    {
        const auto lock = take_rig();
        settings = settings_;
    }
    settings.apparatus = apparatus;
    auto rig = simulate::SimulatedRig::create(settings);
    if (!rig) return tl::unexpected(rig.error());
    const auto lock = take_rig();
    rig->advance_to(rig_.truth().t_s);
    if (settings_.with_colour) rig->turn_on_colour();
    rig_ = std::move(*rig);
    settings_.apparatus = apparatus;
    publish_truth();
    return {};
}

simulate::ApparatusSettings RigClock::apparatus() const {
    const auto lock = take_rig();
    return settings_.apparatus;
}

Result<void> RigClock::apply(const simulate::Command& command) {
    if (fault() == FaultKind::actuator_silent) return {};
    const auto lock = take_rig();
    auto applied = rig_.apply(command);
    publish_truth();
    return applied;
}

void RigClock::turn_on_colour() {
    const auto lock = take_rig();
    settings_.with_colour = true;
    rig_.turn_on_colour();
}

void RigClock::set_fault(FaultKind kind, std::chrono::duration<double> lasting) {
    const std::lock_guard lock(state_mutex_);
    fault_ = kind;
    fault_end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(lasting);
}

RigClock::Seen RigClock::seen() const {
    const std::lock_guard lock(state_mutex_);
    return seen_;
}

FaultKind RigClock::fault() const {
    const std::lock_guard lock(state_mutex_);
    return Clock::now() < fault_end_ ? fault_ : FaultKind::none;
}

std::unique_lock<std::mutex> RigClock::take_rig() const {
    const std::lock_guard turn(turn_mutex_);
    return std::unique_lock(rig_mutex_);
}

/// False when the rig is switched off.
bool RigClock::wait_until(Clock::time_point due) {
    std::unique_lock lock(state_mutex_);
    return !stopping_changed_.wait_until(lock, due, [this] { return stopping_; });
}

/// With the rig's lock held.
void RigClock::publish_truth() {
    const simulate::Truth newest = rig_.truth();
    const std::lock_guard lock(state_mutex_);
    if (newest.motion != seen_.truth.motion) seen_.motion_since_s = newest.t_s;
    seen_.truth = newest;
}

void RigClock::run() {
    const auto start = Clock::now();
    const auto due_time = [start](std::uint64_t frame) {
        const std::chrono::duration<double> since_start(time_of(frame));
        return start + std::chrono::duration_cast<Clock::duration>(since_start);
    };
    RgbdFrame frame;
    for (std::uint64_t k = 1;; ++k) {
        const auto behind = static_cast<std::uint64_t>(
            std::max(0.0, std::chrono::duration<double>(Clock::now() - due_time(k)).count()) *
            simulate::kFrameRateHz
        );
        if (behind > kMostFramesBehind) k += behind;
        const bool watched = watched_();
        {
            const auto lock = take_rig();
            rig_.advance_to(time_of(k));
            if (watched) rig_.render(frame);
        }
        const FaultKind fault = this->fault();
        if (fault == FaultKind::black) std::fill(frame.depth.begin(), frame.depth.end(), 0);
        if (!wait_until(due_time(k))) return;
        {
            const auto lock = take_rig();
            publish_truth();
        }
        if (watched && fault != FaultKind::frozen && fault != FaultKind::unplugged) deliver_(frame);
    }
}

}  // namespace kinectlab::simulated_rig
