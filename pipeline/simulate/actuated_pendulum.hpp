#pragma once

#include <optional>

#include "pipeline/simulate/apparatus.hpp"
#include "pipeline/simulate/pendulum.hpp"

namespace kinectlab::simulate {

/// A pendulum with an arm that brings the bob somewhere and an electromagnet that holds it. Value:
/// the angle between string and vertical in the x-z plane, rad, positive towards +x, at most ±60°.
/// Stopped it hangs at rest in view, so it is held aside while the scene is learned.
/// Copies go on independently.
class ActuatedPendulum final : public Apparatus {
public:
    /// `pivot_lab` is where the string hangs. The parameters have passed check().
    ActuatedPendulum(const PendulumParameters& parameters, const Eigen::Vector3d& pivot_lab);

    [[nodiscard]] Result<void> apply(const Command& command) override;
    void advance_to(double t_s) override;
    [[nodiscard]] double t_s() const override { return t_s_; }
    [[nodiscard]] Motion motion() const override { return motion_; }
    [[nodiscard]] double value() const override;
    [[nodiscard]] std::vector<Body> bodies() const override;
    [[nodiscard]] std::vector<Wire> wires() const override;
    [[nodiscard]] Furniture furniture() const override;
    [[nodiscard]] std::optional<double> aside(double value) const override;
    [[nodiscard]] double usual_value() const override;

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
    void let_go();

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
