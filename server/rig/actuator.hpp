#pragma once

#include <cstdint>

#include "pipeline/core/error.hpp"
#include "server/lab/run.hpp"

namespace kinectlab::rig {

/// What the actuator itself says of the bob; the pipeline measures without it.
enum class BobMotion : std::uint8_t { at_rest, moving_to_angle, held, swinging, braking };

struct ActuatorState {
    BobMotion motion = BobMotion::at_rest;
    double angle_rad = 0.0;  ///< between the string and the vertical
};

/// Moves the bob of one rig. A command that returns was sent, not obeyed: whoever gives one reads
/// state() until it shows the effect. Error unavailable where the device is gone or refuses.
/// Not thread-safe: the rig's worker owns it.
class Actuator {
public:
    Actuator() = default;
    Actuator(const Actuator&) = delete;
    Actuator& operator=(const Actuator&) = delete;
    virtual ~Actuator() = default;

    /// Makes the apparatus what the run's parameters say, as far as it can; the bob is at rest
    /// then.
    [[nodiscard]] virtual Result<void> configure(const lab::Parameters& parameters) = 0;
    /// Brings the bob to this angle in the x-z plane of the lab and holds it there.
    [[nodiscard]] virtual Result<void> displace(double angle_rad) = 0;
    /// Holds the bob where it is.
    [[nodiscard]] virtual Result<void> hold() = 0;
    [[nodiscard]] virtual Result<void> release() = 0;
    /// Brakes the bob until it hangs at rest.
    [[nodiscard]] virtual Result<void> stop() = 0;
    [[nodiscard]] virtual Result<ActuatorState> state() = 0;
};

}  // namespace kinectlab::rig
