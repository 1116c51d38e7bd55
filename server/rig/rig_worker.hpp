#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "server/bus/bus.hpp"
#include "server/experiments/definition.hpp"
#include "server/lab/rig.hpp"
#include "server/rig/active_run.hpp"
#include "server/rig/device.hpp"
#include "server/rig/frame_health.hpp"
#include "server/rig/observer.hpp"
#include "server/rig/pose_writer.hpp"
#include "server/rig/rig_settings.hpp"
#include "server/rig/run_execution.hpp"

namespace kinectlab::rig {

/// What a worker is given from outside, so that tests can play the rig and the time.
struct WorkerParts {
    OpenDevice open;
    std::function<TimeNs()> now;
    RunLimits limits;
};

/// One rig: keeps its device open, watches it, carries out its runs. One thread calls step() and
/// close(); status(), picture() and the run's commands may come from any thread.
class RigWorker {
public:
    /// `idle_plan`: what to look for while no run is under way.
    RigWorker(
        RigSettings settings,
        TrackingPlan idle_plan,
        WorkerParts parts,
        store::Store& store,
        bus::Bus& bus
    );

    /// Takes the next frame, or notices that none came, and does what is due. Returns how long to
    /// pause before the next call. Broken storage throws.
    [[nodiscard]] std::chrono::milliseconds step();

    /// Ends a run that is under way, stops the bob and lets the device go.
    void close(lab::RunEvent event, const std::string& reason);

    /// Stores the run and carries it out. `ready_until`: when it is given up if nobody released it.
    /// Errors: unavailable while offline, conflict while busy.
    [[nodiscard]] Result<lab::Run> start(
        const lab::Run& run, TrackingPlan plan, TimeNs ready_until
    );
    [[nodiscard]] Result<lab::Run> advance(lab::RunId run, const store::RunStep& step);
    [[nodiscard]] lab::RigStatus status() const;
    [[nodiscard]] std::optional<bus::PictureTaken> picture() const;

private:
    /// A stored run that the worker's thread has not seen yet.
    struct RunOrder {
        lab::Run run;
        TrackingPlan plan;
        TimeNs ready_until = 0;
    };

    void open(TimeNs now);
    void take_order(TimeNs now);
    void on_frame(TimeNs now);
    void on_error(TimeNs now, const Error& error);
    void watch_idle(std::uint32_t missed);
    void show_picture(TimeNs now);
    void watch_braking(TimeNs now);
    void end_execution(TimeNs now);
    void go_offline(TimeNs now, const std::string& reason);
    void update_status(TimeNs now);
    [[nodiscard]] RunSurroundings surroundings();

    const RigSettings settings_;
    const TrackingPlan idle_plan_;
    const WorkerParts parts_;
    store::Store& store_;
    bus::Bus& bus_;
    ActiveRun active_;
    PoseWriter writer_;

    // The worker's thread only.
    std::optional<Device> device_;
    std::optional<Observer> observer_;
    std::unique_ptr<RunExecution> execution_;
    FrameHealth health_;
    RgbdFrame frame_;
    TimeNs next_attempt_ = 0;
    TimeNs last_frame_at_ = 0;
    TimeNs last_picture_ = 0;
    TimeNs status_told_ = 0;
    std::optional<TimeNs> braking_since_;  ///< the bob was told to stop and has not confirmed it
    std::string trouble_;

    mutable std::mutex mutex_;  ///< guards what follows
    lab::RigStatus status_;
    std::optional<RunOrder> order_;
    std::optional<bus::PictureTaken> picture_;
};

}  // namespace kinectlab::rig
