#pragma once

#include <optional>

#include "pipeline/simulate/pendulum.hpp"

namespace kinectlab::simulate {

enum class Motion { at_rest, moving_to_angle, held, swinging, braking };

enum class Action {
    stop,      ///< brake the bob until it hangs at rest
    displace,  ///< bring the bob to an angle in the x-z plane, and hold it there
    hold,      ///< switch the electromagnet on where the bob is
    release,   ///< switch the electromagnet off
};

struct Command {
    Action action = Action::stop;
    double angle_rad = 0.0;  ///< displace: positive towards +x, at most ±60°
};

/// The pendulum as it truly is at one time.
struct Truth {
    double t_s = 0.0;  ///< since the rig was switched on
    Motion motion = Motion::at_rest;
    double angle_rad = 0.0;  ///< between string and vertical, never negative
    Eigen::Vector3d p_lab = Eigen::Vector3d::Zero();  ///< bob's centre, m
    Eigen::Vector3d v_lab = Eigen::Vector3d::Zero();  ///< m/s
};

/// A pendulum with an arm that brings the bob somewhere and an electromagnet that holds it.
/// A value: copies go on independently.
class ActuatedPendulum {
public:
    /// `pivot_lab` is where the string hangs. The parameters have passed check().
    ActuatedPendulum(const PendulumParameters& parameters, const Eigen::Vector3d& pivot_lab);

    /// Takes effect at the time of the last advance_to(). A release of a bob that hangs at rest, or
    /// that swings already, changes nothing. An angle beyond ±60° is refused.
    [[nodiscard]] Result<void> apply(const Command& command);

    /// Times before the last one are ignored.
    void advance_to(double t_s);

    [[nodiscard]] Truth truth() const;

private:
    /// The arm's path as a rotation vector of the string, critically damped towards its target.
    struct ArmPath {
        Eigen::Vector2d target = Eigen::Vector2d::Zero();  ///< rad
        Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< rad, at the start
        Eigen::Vector2d rate = Eigen::Vector2d::Zero();    ///< rad/s
        double stiffness = 1.0;                            ///< 1/s
        [[nodiscard]] SwingState at(double t_s) const;
    };

    void move_arm(Motion motion, const Eigen::Vector2d& target, double stiffness);
    void hold_here(Motion motion);

    PendulumParameters parameters_;
    Eigen::Vector3d pivot_lab_;
    Motion motion_ = Motion::at_rest;
    double t_s_ = 0.0;
    double motion_start_s_ = 0.0;
    SwingState state_;
    ArmPath arm_;
    std::optional<Swing> swing_;
};

}  // namespace kinectlab::simulate
