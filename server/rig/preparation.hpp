#pragma once

#include <string>

#include "server/rig/actuator.hpp"

namespace kinectlab::rig {

struct PreparationSettings {
    double amplitude_rad = 0.0;  ///< where the bob is held in the end
    /// Where the bob uncovers all of the scene behind its place of rest; not reached where the
    /// amplitude is larger anyway.
    double clear_angle_rad = 0.0;
    double angle_tolerance_rad = 0.005;     ///< between what was asked for and the echo
    TimeNs learn = kNsPerSecond;            ///< of the scene, with the bob at each place
    TimeNs settle = kNsPerSecond / 2;       ///< before the bob counts as held
    TimeNs step_limit = 60 * kNsPerSecond;  ///< no command may take longer to show its effect
};

/// The angle that moves a bob aside by two and a half of its radii, at most 30°.
[[nodiscard]] double clear_angle(double length_m, double bob_radius_m);

/// Brings the rig from any state to a bob that is held at its angle before a scene that is known:
/// stop → at rest → learn → aside → learn → to the angle → settled. It never waits: it is asked
/// again with every frame.
class Preparation {
public:
    struct Progress {
        bool learn = false;  ///< this frame belongs to the reference scene
        bool done = false;
    };

    Preparation(Actuator& actuator, const PreparationSettings& settings);

    /// Error: the actuator refused, or its echo did not show in time what it was told.
    [[nodiscard]] Result<Progress> step(TimeNs now);

private:
    enum class Stage {
        begin,
        stopping,
        learning_at_rest,
        clearing,
        learning_aside,
        displacing,
        settling,
        done
    };

    [[nodiscard]] Result<void> move_to(double angle_rad, Stage stage, TimeNs now);
    [[nodiscard]] Result<bool> arrived(TimeNs now);
    void enter(Stage stage, TimeNs now);

    Actuator& actuator_;
    PreparationSettings settings_;
    Stage stage_ = Stage::begin;
    TimeNs since_ = 0;
    BobMotion wanted_ = BobMotion::at_rest;
    double wanted_angle_ = 0.0;
};

}  // namespace kinectlab::rig
