#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "pipeline/core/error.hpp"
#include "server/lab/run.hpp"

namespace kinectlab::rig {

/// What the actuator itself says of the apparatus; the pipeline measures without it.
enum class ApparatusMotion : std::uint8_t { at_rest, moving, held, free, braking };

struct ActuatorState {
    ApparatusMotion motion = ApparatusMotion::at_rest;
    /// What displace() sets, as it is now: for a pendulum the angle between the string and the
    /// vertical, rad.
    double value = 0.0;
    /// Since when it moves so, UTC by the frames' clock; none where the device does not know.
    std::optional<TimeNs> since{};
};

/// Moves the apparatus of one rig. A command that returns was sent, not obeyed: whoever gives one
/// reads state() until it shows the effect. Error unavailable where the device is gone or refuses.
/// Not thread-safe: the rig's worker owns it.
class Actuator {
public:
    Actuator() = default;
    Actuator(const Actuator&) = delete;
    Actuator& operator=(const Actuator&) = delete;
    virtual ~Actuator() = default;

    /// Makes the rig this apparatus as the run's parameters say, as far as it can; parameters that
    /// are not the apparatus' are passed over. It is at rest then.
    [[nodiscard]] virtual Result<void> configure(
        const std::string& apparatus, const lab::Parameters& parameters
    ) = 0;
    /// Brings everything to its start, displaced by so many rad or m as the apparatus says (a
    /// pendulum's angle in the x-z plane of the lab), and holds it there.
    [[nodiscard]] virtual Result<void> displace(double value) = 0;
    /// Holds everything where it is.
    [[nodiscard]] virtual Result<void> hold() = 0;
    [[nodiscard]] virtual Result<void> release() = 0;
    /// Brings everything to rest, so that the scene behind it can be learned.
    [[nodiscard]] virtual Result<void> stop() = 0;
    [[nodiscard]] virtual Result<ActuatorState> state() = 0;
};

}  // namespace kinectlab::rig
