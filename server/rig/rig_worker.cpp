#include "server/rig/rig_worker.hpp"

#include <cmath>
#include <exception>

#include "server/lab/utc.hpp"

namespace kinectlab::rig {
namespace {

using namespace std::chrono_literals;

constexpr auto kFrameTimeout = 100ms;
constexpr auto kOfflinePause = 100ms;
constexpr TimeNs kRetry = 3 * kNsPerSecond;
constexpr TimeNs kSilent = 2 * kNsPerSecond;  ///< without a frame a rig is offline
constexpr TimeNs kPicturePeriod = kNsPerSecond / 10;
constexpr TimeNs kStatusPeriod = kNsPerSecond;    ///< of figures that wander by themselves
constexpr TimeNs kSignOfLife = 2 * kNsPerSecond;  ///< a viewer tells a quiet rig from a lost line
constexpr std::size_t kIdleReference = 30;        ///< frames that an idle rig learns its scene from

std::string busy_sentence(const lab::Run& run) {
    switch (run.state) {
        case lab::RunState::preparing:
            return "Preparing a run";
        case lab::RunState::ready:
            return "Ready to be released";
        case lab::RunState::releasing:
            return "Releasing the bob";
        case lab::RunState::measuring:
            return "Measuring";
        case lab::RunState::analysing:
            return "Analysing";
        default:
            return "Bringing the bob to rest";
    }
}

bool same_for_people(const lab::RigStatus& a, const lab::RigStatus& b) {
    return a.state == b.state && a.sentence == b.sentence && a.current_run == b.current_run;
}

bool same_figures(const lab::RigStatus& a, const lab::RigStatus& b) {
    return std::abs(a.frame_rate_hz - b.frame_rate_hz) < 0.5 && a.frames_lost == b.frames_lost;
}

}  // namespace

RigWorker::RigWorker(
    RigSettings settings,
    TrackingPlan idle_plan,
    WorkerParts parts,
    store::Store& store,
    bus::Bus& bus
)
    : settings_(std::move(settings)),
      idle_plan_(std::move(idle_plan)),
      parts_(std::move(parts)),
      store_(store),
      bus_(bus),
      active_(store, bus),
      writer_(store.poses) {
    status_.id = settings_.id;
    status_.name = settings_.name;
    status_.simulated = is_simulated(settings_.uri);
    status_.experiments = settings_.experiments;
    status_.sentence = "Offline: starting";
}

std::chrono::milliseconds RigWorker::step() {
    if (!device_) {
        const TimeNs now = parts_.now();
        if (now >= next_attempt_) open(now);
        if (!device_) {
            update_status(now);
            return kOfflinePause;
        }
    }
    const auto status = device_->source->next(frame_, kFrameTimeout);
    const TimeNs now = parts_.now();
    take_order(now);
    if (!status) {
        on_error(now, status.error());
        return 0ms;
    }
    if (*status == FrameStatus::end) {
        on_error(now, {ErrorCode::unavailable, "camera", "the recording is over"});
        return 0ms;
    }
    if (*status == FrameStatus::frame) {
        on_frame(now);
    } else if (execution_) {
        execution_->step(now, nullptr, 0);
    }
    if (execution_ && execution_->over()) end_execution(now);
    update_status(now);
    // A device that is gone says so at once: do not ask it in a tight loop.
    return *status == FrameStatus::disconnected ? kOfflinePause : 0ms;
}

void RigWorker::open(TimeNs now) {
    auto device = parts_.open();
    if (!device) return go_offline(now, to_text(device.error()));
    auto observer = Observer::create(device->source->info(), idle_plan_);
    if (!observer) return go_offline(now, to_text(observer.error()));
    // A run that is still open here lost its worker in a breakdown.
    store_.runs.interrupt_unfinished(now, "the rig broke down during the run", settings_.id);
    device_ = std::move(*device);
    observer_ = std::move(*observer);
    last_frame_at_ = now;
    // Whatever the bob did when the last program ended: nobody is measuring now.
    trouble_.clear();
    if (auto stopped = device_->actuator->stop(); !stopped) trouble_ = to_text(stopped.error());
}

void RigWorker::take_order(TimeNs now) {
    std::optional<RunOrder> order;
    {
        const std::lock_guard lock(mutex_);
        order.swap(order_);
    }
    if (!order) return;
    trouble_.clear();
    auto observer = Observer::create(device_->source->info(), order->plan);
    if (observer) {
        observer_ = std::move(*observer);
        execution_ = std::make_unique<RunExecution>(surroundings(), order->run, now, parts_.limits);
    } else {
        (void)active_.advance({lab::RunEvent::fail, now, to_text(observer.error()), {}});
        active_.clear();
    }
}

RunSurroundings RigWorker::surroundings() {
    return {*device_, *observer_, active_, writer_, store_, bus_};
}

void RigWorker::on_frame(TimeNs now) {
    const std::uint32_t missed = health_.on_frame(frame_.index, frame_.t);
    last_frame_at_ = now;
    if (execution_) {
        execution_->step(now, &frame_, missed);
    } else {
        watch_braking(now);
        watch_idle(missed);
    }
    show_picture(now);
}

/// An idle rig shows its bob too, where its scene is known well enough to see it.
void RigWorker::watch_idle(std::uint32_t missed) {
    if (observer_->learned_frames() < kIdleReference) {
        if (auto learned = observer_->learn(frame_); !learned) trouble_ = to_text(learned.error());
        return;
    }
    const auto observed = observer_->track(frame_);
    if (!observed) {
        trouble_ = to_text(observed.error());
        return;
    }
    for (const Observed& object : *observed) {
        if (object.motion.status != TrackStatus::tracked) continue;
        bus_.publish(bus::PoseMeasured{
            settings_.id, std::nullopt, object.object, object.motion, missed});
    }
}

void RigWorker::show_picture(TimeNs now) {
    if (frame_.rgb.empty() || now - last_picture_ < kPicturePeriod) return;
    last_picture_ = now;
    const Pinhole& colour = device_->source->info().camera.colour;
    bus::PictureTaken picture{
        settings_.id,
        frame_.t_colour,
        colour.width,
        colour.height,
        std::make_shared<const std::vector<std::uint8_t>>(frame_.rgb)};
    {
        const std::lock_guard lock(mutex_);
        picture_ = picture;
    }
    bus_.publish(std::move(picture));
}

void RigWorker::on_error(TimeNs now, const Error& error) {
    if (execution_) {
        execution_->end(lab::RunEvent::fail, now, to_text(error));
        end_execution(now);
    }
    go_offline(now, to_text(error));
}

void RigWorker::end_execution(TimeNs now) {
    if (!execution_->trouble().empty())
        trouble_ = "the bob was not stopped: " + execution_->trouble();
    execution_.reset();
    active_.clear();
    braking_since_ = now;
}

/// A rig is in order only when its actuator says that the bob hangs at rest.
void RigWorker::watch_braking(TimeNs now) {
    if (!braking_since_) return;
    const auto state = device_->actuator->state();
    if (state && state->motion == ApparatusMotion::at_rest) {
        braking_since_.reset();
    } else if (now - *braking_since_ > parts_.limits.stop_echo) {
        trouble_ = "the bob did not come to rest";
        braking_since_.reset();
    }
}

void RigWorker::close(lab::RunEvent event, const std::string& reason) {
    const TimeNs now = parts_.now();
    // The bob first: to stop it takes no disk, and the disk may be what is broken.
    if (device_) (void)device_->actuator->stop();
    std::exception_ptr broken;
    try {
        if (device_) take_order(now);
        if (execution_) execution_->end(event, now, reason);
    } catch (...) {
        broken = std::current_exception();
    }
    execution_.reset();
    active_.clear();
    go_offline(now, reason);
    if (broken) std::rethrow_exception(broken);
}

Result<lab::Run> RigWorker::start(const lab::Run& run, TrackingPlan plan) {
    const std::lock_guard lock(mutex_);
    if (status_.state == lab::RigState::offline) {
        return fail(
            ErrorCode::unavailable,
            "rig",
            status_.sentence,
            "try again in a moment, or choose another rig"
        );
    }
    if (order_ || active_.current()) {
        return fail(
            ErrorCode::conflict, "rig", "is busy with another run", "wait until it is over"
        );
    }
    auto stored = store_.runs.add(run);
    if (!stored) return stored;
    active_.begin(*stored);
    order_ = RunOrder{*stored, std::move(plan)};
    return stored;
}

Result<lab::Run> RigWorker::advance(lab::RunId run, const store::RunStep& step) {
    return active_.advance(run, step);
}

lab::RigStatus RigWorker::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

std::optional<bus::PictureTaken> RigWorker::picture() const {
    const std::lock_guard lock(mutex_);
    if (status_.state == lab::RigState::offline) return std::nullopt;
    return picture_;
}

void RigWorker::go_offline(TimeNs now, const std::string& reason) {
    observer_.reset();
    device_.reset();
    next_attempt_ = now + kRetry;
    trouble_ = reason;
    update_status(now);
}

void RigWorker::update_status(TimeNs now) {
    const auto run = active_.current();
    const std::lock_guard lock(mutex_);
    lab::RigStatus status = status_;
    status.current_run = run ? std::optional(run->id) : std::nullopt;
    status.frame_rate_hz = std::round(health_.rate_hz(now) * 10.0) / 10.0;
    status.frames_lost = health_.lost();
    if (!device_) {
        status.state = lab::RigState::offline;
        status.sentence = "Offline: " + trouble_;
    } else if (run) {
        status.state = lab::RigState::busy;
        status.sentence = busy_sentence(*run);
    } else if (now - last_frame_at_ > kSilent) {
        status.state = lab::RigState::offline;
        status.sentence = "Offline: no frame for " + lab::span_text(now - last_frame_at_);
    } else if (health_.rate_hz(now) > 0.0) {
        status.state = lab::RigState::idle;
        status.sentence = trouble_.empty() ? "Free" : "Needs attention: " + trouble_;
    }
    const TimeNs silent = now - status_told_;
    const bool due =
        silent >= kSignOfLife || (silent >= kStatusPeriod && !same_figures(status, status_));
    if (same_for_people(status, status_) && !due) return;
    status_ = status;
    status_told_ = now;
    bus_.publish(bus::RigChanged{status_});
}

}  // namespace kinectlab::rig
