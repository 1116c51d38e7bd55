#pragma once

#include <vector>

#include "server/experiments/definition.hpp"
#include "server/rig/actuator.hpp"

namespace kinectlab::rig {

/// One step of a preparation, its numbers worked out for this run.
struct PreparationStep {
    experiments::SequenceStep::Kind kind = experiments::SequenceStep::Kind::stop;
    double value = 0.0;       ///< of displace and clear: where to, as the actuator takes it
    double seconds = 0.0;     ///< of wait
    bool in_degrees = false;  ///< tell people the value as an angle
    bool learn = false;       ///< the frames meanwhile belong to the reference scene
};

struct PreparationSettings {
    std::vector<PreparationStep> steps;
    double tolerance = 0.005;               ///< between what was asked for and the echo
    TimeNs step_limit = 60 * kNsPerSecond;  ///< no command may take longer to show its effect
};

/// The angle that moves a bob aside by two and a half of its radii, at most 30°.
[[nodiscard]] double clear_angle(double length_m, double bob_radius_m);

/// The definition's sequence with the run's values; degrees become radians.
[[nodiscard]] PreparationSettings preparation_for(
    const experiments::Definition& definition, const experiments::Values& values
);

/// Brings the rig from any state to an object that is held where it is released from, before a
/// scene that is known. It never waits: it is asked again with every frame.
class Preparation {
public:
    struct Progress {
        bool learn = false;  ///< this frame belongs to the reference scene
        bool done = false;
    };

    Preparation(Actuator& actuator, PreparationSettings settings);

    /// Error: the actuator refused, or its echo did not show in time what it was told.
    [[nodiscard]] Result<Progress> step(TimeNs now);

private:
    [[nodiscard]] Result<void> begin(const PreparationStep& step);
    [[nodiscard]] Result<bool> over(const PreparationStep& step, TimeNs now);

    Actuator& actuator_;
    PreparationSettings settings_;
    std::size_t at_ = 0;
    bool begun_ = false;
    TimeNs since_ = 0;
};

}  // namespace kinectlab::rig
