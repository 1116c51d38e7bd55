#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "pipeline/drivers/simulated_rig/protocol.hpp"
#include "pipeline/simulate/simulated_rig.hpp"

namespace kinectlab::simulated_rig {

/// Runs a simulated rig in real time, on a thread of its own, from construction to destruction.
/// Frame k is due, and was captured, k/30 s after the start by the steady clock. It is rendered
/// before that and handed out then. A machine that falls behind hands frames out late; one that is
/// too far behind loses frames, which shows as a gap in the index.
class RigClock {
public:
    /// True while anybody wants pictures; without, only the apparatus moves.
    using Watched = std::function<bool()>;
    /// Called from the rig's thread, without any lock held.
    using Deliver = std::function<void(const RgbdFrame& frame)>;

    /// The settings have passed SimulatedRig::create.
    RigClock(simulate::RigSettings settings, Watched watched, Deliver deliver);
    RigClock(const RigClock&) = delete;
    RigClock& operator=(const RigClock&) = delete;
    ~RigClock();

    // What follows may be called from any thread.

    /// Another apparatus, at rest; costs the time of rendering the room once.
    [[nodiscard]] Result<void> set_apparatus(const simulate::ApparatusSettings& apparatus);
    [[nodiscard]] simulate::ApparatusSettings apparatus() const;

    /// Takes effect with the next frame to be rendered.
    [[nodiscard]] Result<void> apply(const simulate::Command& command);

    /// Turns the colour camera on for good. Frames that are due meanwhile come late.
    void turn_on_colour();

    void set_fault(FaultKind kind, std::chrono::duration<double> lasting);

    struct Seen {
        simulate::Truth truth;
        double motion_since_s = 0.0;  ///< since when truth.motion is what it is
    };
    /// Truth of the frame that was handed out last, or of the one that is ready to be when a
    /// command came in between; the command shows at once, so that nobody mistakes an old state for
    /// its effect.
    [[nodiscard]] Seen seen() const;

    [[nodiscard]] const RgbdCamera& camera() const { return camera_; }
    [[nodiscard]] const Eigen::Isometry3d& T_lab_cam() const { return T_lab_cam_; }

private:
    using Clock = std::chrono::steady_clock;
    void run();
    bool wait_until(Clock::time_point due);

    /// Whoever waits for the rig comes before the next frame: without turns the rendering loop
    /// would take it again at once, and where rendering is slower than time nobody else ever got
    /// it.
    [[nodiscard]] std::unique_lock<std::mutex> take_rig() const;
    void publish_truth();
    [[nodiscard]] FaultKind fault() const;

    const Watched watched_;
    const Deliver deliver_;
    RgbdCamera camera_;
    Eigen::Isometry3d T_lab_cam_;

    mutable std::mutex turn_mutex_;  ///< held while waiting for the rig, see take_rig()
    mutable std::mutex rig_mutex_;   ///< guards the next two
    simulate::RigSettings settings_;
    simulate::SimulatedRig rig_;

    mutable std::mutex state_mutex_;  ///< guards the rest; never held while rendering
    std::condition_variable stopping_changed_;
    bool stopping_ = false;
    Seen seen_;
    FaultKind fault_ = FaultKind::none;
    Clock::time_point fault_end_;

    std::thread thread_;  ///< last: starts when everything else is there
};

}  // namespace kinectlab::simulated_rig
