#include "pipeline/simulate/actuated_pendulum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "pipeline/core/number_text.hpp"

namespace kinectlab::simulate {
namespace {

constexpr double kLargestAngle = std::numbers::pi / 3.0;
constexpr double kDisplaceStiffness = 7.0;  ///< 1/s: at the angle after 2 s
constexpr double kBrakeStiffness = 5.0;     ///< 1/s: at rest after 2.8 s
constexpr double kArrived = 14.0;  ///< stiffness x time after which 1e-5 of the way is left

/// String direction ↔ rotation vector (angle from the vertical, along the horizontal direction).
struct Polar {
    double angle;
    Eigen::Vector2d heading;  ///< unit, horizontal
    [[nodiscard]] Eigen::Vector2d across() const { return {-heading.y(), heading.x()}; }
    [[nodiscard]] Eigen::Vector3d direction() const {
        return {std::sin(angle) * heading.x(), std::sin(angle) * heading.y(), -std::cos(angle)};
    }
    [[nodiscard]] Eigen::Vector3d outwards() const {
        return {std::cos(angle) * heading.x(), std::cos(angle) * heading.y(), std::sin(angle)};
    }
    /// sin(angle)/angle
    [[nodiscard]] double shrink() const { return angle < 1e-6 ? 1.0 : std::sin(angle) / angle; }
};

Polar polar_of(const Eigen::Vector2d& rotation) {
    const double angle = rotation.norm();
    return {angle, angle > 0.0 ? Eigen::Vector2d(rotation / angle) : Eigen::Vector2d::UnitX()};
}

Polar polar_of(const Eigen::Vector3d& n) {
    const double horizontal = n.head<2>().norm();
    return {
        std::atan2(horizontal, -n.z()),
        horizontal > 0.0 ? Eigen::Vector2d(n.head<2>() / horizontal) : Eigen::Vector2d::UnitX()};
}

Eigen::Vector2d rotation_rate(const Polar& polar, const Eigen::Vector3d& n_dot) {
    return polar.outwards().dot(n_dot) * polar.heading +
           polar.across().dot(n_dot.head<2>()) / polar.shrink() * polar.across();
}

}  // namespace

SwingState ActuatedPendulum::ArmPath::at(double t_s) const {
    const double fade = std::exp(-stiffness * t_s);
    const Eigen::Vector2d slope = rate + stiffness * offset;
    const Eigen::Vector2d rotation = target + fade * (offset + t_s * slope);
    const Eigen::Vector2d turning = fade * (rate - t_s * stiffness * slope);
    const Polar polar = polar_of(rotation);
    SwingState state;
    state.n = polar.direction();
    state.n_dot = turning.dot(polar.heading) * polar.outwards();
    state.n_dot.head<2>() += turning.dot(polar.across()) * polar.shrink() * polar.across();
    return state;
}

ActuatedPendulum::ActuatedPendulum(
    const PendulumParameters& parameters, const Eigen::Vector3d& pivot_lab
)
    : parameters_(parameters), pivot_lab_(pivot_lab) {}

Result<void> ActuatedPendulum::apply(const Command& command) {
    switch (command.action) {
        case Action::stop:
            if (motion_ == Motion::at_rest || motion_ == Motion::braking) return {};
            move_arm(Motion::braking, Eigen::Vector2d::Zero(), kBrakeStiffness);
            return {};
        case Action::displace:
            if (!(std::abs(command.value) <= kLargestAngle))
                return fail(
                    ErrorCode::invalid_argument,
                    "angle_rad",
                    "is " + number_text(command.value),
                    "give an angle from -1.047 to 1.047 rad (60 degrees)"
                );
            move_arm(Motion::moving, command.value * Eigen::Vector2d::UnitX(), kDisplaceStiffness);
            return {};
        case Action::hold:
            hold_here(Motion::held);
            return {};
        case Action::release:
            if (motion_ == Motion::free || motion_ == Motion::at_rest) return {};
            let_go();
            return {};
    }
    return fail(
        ErrorCode::invalid_argument, "action", "is unknown", "stop, displace, hold, release"
    );
}

void ActuatedPendulum::advance_to(double t_s) {
    if (!(t_s > t_s_)) return;
    t_s_ = t_s;
    const double since_start = t_s_ - motion_start_s_;
    if (motion_ == Motion::free) state_ = swing_->at(since_start);
    if (motion_ == Motion::moving || motion_ == Motion::braking) {
        const bool arrived = since_start * arm_.stiffness >= kArrived;
        state_ = arm_.at(since_start);
        if (arrived) {
            state_.n = polar_of(arm_.target).direction();
            hold_here(motion_ == Motion::braking ? Motion::at_rest : Motion::held);
        }
    }
}

double ActuatedPendulum::value() const {
    return std::copysign(polar_of(state_.n).angle, state_.n.x());
}

std::vector<Body> ActuatedPendulum::bodies() const {
    Body bob{"bob", Sphere{parameters_.bob_radius_m}};
    bob.p_lab = pivot_lab_ + parameters_.length_m * state_.n;
    bob.v_lab = parameters_.length_m * state_.n_dot;
    bob.w_lab = state_.n.cross(state_.n_dot);
    bob.q_lab_body.setFromTwoVectors(-Eigen::Vector3d::UnitZ(), state_.n);
    return {bob};
}

std::vector<Wire> ActuatedPendulum::wires() const {
    return {{pivot_lab_, pivot_lab_ + parameters_.length_m * state_.n}};
}

Furniture ActuatedPendulum::furniture() const {
    return {true, pivot_lab_.z(), {}};
}

/// Where the bob leaves free what it hides at rest: its centre two and a half radii to the side.
std::optional<double> ActuatedPendulum::aside(double value) const {
    const double sine = 2.5 * parameters_.bob_radius_m / parameters_.length_m;
    const double angle = std::min(std::asin(std::min(sine, 1.0)), std::numbers::pi / 6.0);
    if (angle <= std::abs(value)) return std::nullopt;
    return std::copysign(angle, value);
}

double ActuatedPendulum::usual_value() const {
    return std::numbers::pi / 18.0;
}

void ActuatedPendulum::let_go() {
    if (parameters_.sideways_m_s != 0.0) {
        const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
        const Eigen::Vector3d across = (y - y.dot(state_.n) * state_.n).normalized();
        state_.n_dot += parameters_.sideways_m_s / parameters_.length_m * across;
    }
    swing_.emplace(parameters_, state_);
    motion_ = Motion::free;
    motion_start_s_ = t_s_;
}

void ActuatedPendulum::move_arm(Motion motion, const Eigen::Vector2d& target, double stiffness) {
    const Polar polar = polar_of(state_.n);
    arm_.target = target;
    arm_.offset = polar.angle * polar.heading - target;
    arm_.rate = rotation_rate(polar, state_.n_dot);
    arm_.stiffness = stiffness;
    motion_ = motion;
    motion_start_s_ = t_s_;
}

void ActuatedPendulum::hold_here(Motion motion) {
    state_.n_dot.setZero();
    motion_ = motion;
}

}  // namespace kinectlab::simulate
