#include "server/rig/rig_service.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "server/lab/permissions.hpp"
#include "server/lab/utc.hpp"
#include "server/rig/rig_worker.hpp"

namespace kinectlab::rig {
namespace {

using lab::RunEvent;

constexpr TimeNs kReadyAtMost = 300 * kNsPerSecond;
constexpr std::chrono::seconds kPauseAfterBreakdown{3};

TimeNs utc_now() {
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
}

/// A rig with the thread that works for it.
class Lane {
public:
    Lane(const RigSettings& settings, TrackingPlan idle_plan, store::Store& store, bus::Bus& bus)
        : settings_(settings),
          worker_(
              settings,
              std::move(idle_plan),
              {[uri = settings.uri] { return open_device(uri); }, utc_now, {}},
              store,
              bus
          ),
          thread_([this] { work(); }) {}

    ~Lane() { stop(); }
    Lane(const Lane&) = delete;
    Lane& operator=(const Lane&) = delete;

    void ask_to_stop() { stopping_ = true; }

    void stop() {
        stopping_ = true;
        if (thread_.joinable()) thread_.join();
    }

    [[nodiscard]] const RigSettings& settings() const { return settings_; }
    [[nodiscard]] RigWorker& worker() { return worker_; }

private:
    void work() {
        while (!stopping_) {
            try {
                std::this_thread::sleep_for(worker_.step());
            } catch (const std::exception& broken) {
                spdlog::error("{}: {}", settings_.id, broken.what());
                close(RunEvent::fail, broken.what());
                pause();
            }
        }
        close(RunEvent::interrupt, "the server was shut down");
    }

    void close(RunEvent event, const std::string& reason) {
        try {
            worker_.close(event, reason);
        } catch (const std::exception& broken) {
            // What is left open in the store is interrupted at the next start.
            spdlog::error("{}: while ending its run: {}", settings_.id, broken.what());
        }
    }

    void pause() {
        const auto until = std::chrono::steady_clock::now() + kPauseAfterBreakdown;
        while (!stopping_ && std::chrono::steady_clock::now() < until) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
    }

    const RigSettings settings_;
    std::atomic<bool> stopping_{false};
    RigWorker worker_;
    std::thread thread_;  // last: it uses all the others
};

Error under_parameters(Error error) {
    if (!error.field.empty()) error.field = "parameters." + error.field;
    return error;
}

}  // namespace

struct RigService::State {
    const ExperimentLibrary& library;
    store::Store& store;
    std::vector<std::unique_ptr<Lane>> lanes;

    [[nodiscard]] Result<Lane*> lane(const std::string& id) const {
        for (const auto& lane : lanes) {
            if (lane->settings().id == id) return lane.get();
        }
        return fail(ErrorCode::not_found, "rig", "there is no rig \"" + id + "\"");
    }

    /// A rig does the experiments that its settings name, and what was published for the same
    /// apparatus.
    [[nodiscard]] bool offers(const RigSettings& rig, const experiments::Definition& definition)
        const {
        for (const auto& id : rig.experiments) {
            if (id == definition.id) return true;
            const auto named = library.offered(id);
            if (named && named->apparatus == definition.apparatus) return true;
        }
        return false;
    }

    [[nodiscard]] Result<lab::Run> command(
        const lab::User& user, lab::RunId id, RunEvent event, const std::string& cause, TimeNs now
    );
    [[nodiscard]] lab::RigStatus with_outlook(lab::RigStatus status, TimeNs now) const;
};

RigService::RigService(
    const std::vector<RigSettings>& rigs,
    const ExperimentLibrary& library,
    store::Store& store,
    bus::Bus& bus
)
    : state_(new State{library, store, {}}) {
    store.runs.interrupt_unfinished(utc_now(), "the server went away during the run");
    for (const RigSettings& settings : rigs) {
        TrackingPlan idle_plan;
        for (const auto& id : settings.experiments) {
            const auto definition = library.offered(id);
            if (!definition) continue;
            if (const auto values = experiments::validate(*definition, {})) {
                idle_plan = experiments::plan_for(*definition, *values);
                break;
            }
        }
        state_->lanes.push_back(std::make_unique<Lane>(settings, idle_plan, store, bus));
    }
}

RigService::~RigService() {
    shutdown();
}

std::vector<lab::RigStatus> RigService::list(TimeNs now) const {
    std::vector<lab::RigStatus> rigs;
    for (const auto& lane : state_->lanes) {
        rigs.push_back(state_->with_outlook(lane->worker().status(), now));
    }
    return rigs;
}

std::optional<lab::RigStatus> RigService::find(const std::string& rig, TimeNs now) const {
    const auto lane = state_->lane(rig);
    if (!lane) return std::nullopt;
    return state_->with_outlook((*lane)->worker().status(), now);
}

/// Says in spans, not in times of day, how long a free rig stays free: the reader's zone is not
/// known here.
lab::RigStatus RigService::State::with_outlook(lab::RigStatus status, TimeNs now) const {
    if (const auto rig = lane(status.id)) {
        status.experiments.clear();
        for (const auto& definition : library.all_offered())
            if (offers((*rig)->settings(), definition)) status.experiments.push_back(definition.id);
    }
    if (status.state != lab::RigState::idle || status.sentence != "Free") return status;
    constexpr TimeNs kOutlook = 12 * 3600 * kNsPerSecond;
    const auto bookings = store.bookings.on_rig(status.id, now, now + kOutlook);
    if (bookings.empty()) return status;
    const lab::Slot& next = bookings.front().slot;
    status.sentence = next.start <= now ? "Booked for another " + lab::span_text(next.end - now)
                                        : "Free for " + lab::span_text(next.start - now);
    return status;
}

Result<lab::Run> RigService::start_run(
    const lab::User& user, const RunRequest& request, TimeNs now
) {
    const auto lane = state_->lane(request.rig);
    if (!lane) return tl::unexpected(lane.error());
    const RigSettings& rig = (*lane)->settings();
    const auto definition = state_->library.offered(request.experiment);
    if (!definition || !state_->offers(rig, *definition)) {
        return fail(
            ErrorCode::not_found,
            "experiment",
            "\"" + request.experiment + "\" is not offered on " + rig.id
        );
    }
    const auto kind =
        is_simulated(rig.uri) ? experiments::RigKind::simulated : experiments::RigKind::real;
    const auto values = experiments::validate(*definition, request.parameters, kind);
    if (!values) return tl::unexpected(under_parameters(values.error()));

    const auto booking = state_->store.bookings.at(rig.id, now);
    if (!booking) {
        return fail(ErrorCode::conflict, "rig", "is not booked by you now", "book a slot first");
    }
    const double duration_s = experiments::value_of(definition->duration, *values).value_or(30.0);
    if (auto allowed = lab::may_start_run(user, *booking, duration_s, now); !allowed) {
        const bool too_long = allowed.error().field == "duration_s";
        return tl::unexpected(too_long ? under_parameters(allowed.error()) : allowed.error());
    }
    return (*lane)->worker().start(
        {
            .rig = rig.id,
            .experiment = definition->id,
            .user = user.id,
            .booking = booking->id,
            .parameters = *values,
            .definition_json = experiments::to_json(*definition).dump(),
            .duration_s = duration_s,
            .created = now,
            .release_until =
                std::min(now + kReadyAtMost, booking->slot.end - from_seconds(duration_s)),
        },
        experiments::plan_for(*definition, *values)
    );
}

Result<lab::Run> RigService::State::command(
    const lab::User& user, lab::RunId id, RunEvent event, const std::string& cause, TimeNs now
) {
    const auto run = store.runs.find(id);
    if (!run) return fail(ErrorCode::not_found, "run", "there is no run " + std::to_string(id));
    if (auto allowed = lab::may_command_run(user, *run); !allowed) {
        return tl::unexpected(allowed.error());
    }
    const auto lane = this->lane(run->rig);
    if (!lane) return tl::unexpected(lane.error());
    return (*lane)->worker().advance(id, {event, now, cause, user.id});
}

Result<lab::Run> RigService::release(const lab::User& user, lab::RunId run, TimeNs now) {
    return state_->command(
        user, run, RunEvent::release_commanded, "Released by " + user.display_name, now
    );
}

Result<lab::Run> RigService::stop(const lab::User& user, lab::RunId run, TimeNs now) {
    return state_->command(user, run, RunEvent::measured, "Stopped by " + user.display_name, now);
}

Result<lab::Run> RigService::abort(const lab::User& user, lab::RunId run, TimeNs now) {
    return state_->command(user, run, RunEvent::abort, "Aborted by " + user.display_name, now);
}

Result<bus::PictureTaken> RigService::picture(const std::string& rig) const {
    const auto lane = state_->lane(rig);
    if (!lane) return tl::unexpected(lane.error());
    auto picture = (*lane)->worker().picture();
    if (!picture)
        return fail(ErrorCode::unavailable, "rig", "has no picture now", "try again later");
    return *picture;
}

void RigService::shutdown() {
    for (const auto& lane : state_->lanes)
        lane->ask_to_stop();
    for (const auto& lane : state_->lanes)
        lane->stop();
}

}  // namespace kinectlab::rig
