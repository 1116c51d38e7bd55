#pragma once

#include <memory>
#include <optional>

#include "pipeline/simulate/actuated_pendulum.hpp"
#include "pipeline/simulate/simulated_rig.hpp"
#include "server/rig/device.hpp"

namespace kinectlab::test {

/// A rig that a test plays: its time is the frames', its faults are the test's. With `rendered` its
/// camera sees what the simulated rig renders, else a small picture of a bare wall.
struct PlayedRig {
    explicit PlayedRig(TimeNs start, bool rendered = false);

    TimeNs start;
    double t_s = 0.0;  ///< moved on by the source
    std::optional<simulate::SimulatedRig> rendered;
    simulate::ActuatedPendulum bare;

    // Faults.
    bool absent = false;    ///< cannot be opened
    bool refusing = false;  ///< the actuator answers every command with an error
    bool deaf = false;      ///< the actuator takes commands and does nothing
    FrameStatus status = FrameStatus::frame;
    std::uint64_t skip = 0;  ///< frames to lose before the next

    std::optional<TimeNs> since;  ///< what the actuator says of its motion's beginning

    std::uint64_t index = 0;
    int stops = 0;  ///< how often the bob was told to stop

    [[nodiscard]] TimeNs now() const { return start + from_seconds(t_s); }
    [[nodiscard]] simulate::Truth truth() const {
        return rendered ? rendered->truth() : bare.truth();
    }
    Result<void> apply(const simulate::Command& command) {
        return rendered ? rendered->apply(command) : bare.apply(command);
    }
    void advance(double seconds);

    /// What a worker opens. The rig must outlive it.
    [[nodiscard]] Result<rig::Device> open();
};

}  // namespace kinectlab::test
