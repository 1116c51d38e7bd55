#pragma once

#include <future>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/bus/bus.hpp"
#include "server/rig/active_run.hpp"
#include "server/rig/device.hpp"
#include "server/rig/end_watch.hpp"
#include "server/rig/observer.hpp"
#include "server/rig/pose_writer.hpp"
#include "server/rig/preparation.hpp"
#include "server/rig/run_analysis.hpp"

namespace kinectlab::rig {

/// How long a run waits for what may never come.
struct RunLimits {
    TimeNs sensor_silence = 5 * kNsPerSecond;  ///< without a frame, before the run fails
    TimeNs release_echo = 10 * kNsPerSecond;   ///< until the actuator says that the bob swings
    TimeNs stop_echo = 90 * kNsPerSecond;      ///< until it says that the bob hangs at rest
};

/// What a run needs of its rig. All of it outlives the execution.
struct RunSurroundings {
    Device& device;
    Observer& observer;
    ActiveRun& active;
    PoseWriter& writer;
    store::Store& store;
    bus::Bus& bus;
};

/// Carries out one run on its rig. The stored state leads: whoever wrote it, the next step notices
/// the change and acts on it. It never waits, except at the end for the disk. The rig's worker owns
/// it and calls step() with every frame, and without one while none comes.
class RunExecution {
public:
    RunExecution(
        RunSurroundings rig, const lab::Run& run, TimeNs now, const RunLimits& limits = {}
    );

    /// `missed`: frames that the device lost just before this one.
    void step(TimeNs now, const RgbdFrame* frame, std::uint32_t missed);

    /// The run is in a final state and the rig has been left in order.
    [[nodiscard]] bool over() const;

    /// Ends the run now, e.g. because the server is going away. An analysis that is under way is
    /// waited for and kept.
    void end(lab::RunEvent event, TimeNs now, const std::string& reason);

    /// Why the bob could not be stopped, if so: the rig needs somebody.
    [[nodiscard]] const std::string& trouble() const { return trouble_; }

private:
    void act_on_changes(TimeNs now);
    void enter(lab::RunState state, TimeNs now);
    [[nodiscard]] Result<void> begin_preparation();
    void observe(lab::RunState state, TimeNs now, const RgbdFrame& frame, std::uint32_t missed);
    void watch(lab::RunState state, TimeNs now);
    void prepare(TimeNs now, const RgbdFrame& frame, std::uint32_t missed);
    void track(lab::RunState state, TimeNs now, const RgbdFrame& frame, std::uint32_t missed);
    void await_release(TimeNs now);
    void finish_analysis(TimeNs now);
    void save_frames();
    void stop_bob();
    void advance(lab::RunEvent event, TimeNs now, const std::string& cause);
    void fail_run(TimeNs now, const Error& error);

    RunSurroundings rig_;
    lab::Run run_;
    RunLimits limits_;
    std::optional<lab::RunState> entered_;
    TimeNs entered_at_ = 0;
    TimeNs last_frame_at_;
    std::optional<Preparation> preparation_;
    std::optional<EndWatch> end_watch_;
    std::map<std::string, std::vector<TrackSample>> samples_;  ///< by object
    std::int64_t frames_ = 0;
    std::int64_t frames_lost_ = 0;
    std::pair<std::int64_t, std::int64_t> saved_frames_;  ///< what the store knows of both
    std::future<Result<RunAnalysis>> analysis_;
    std::string trouble_;
    bool over_ = false;
};

}  // namespace kinectlab::rig
