#include "pipeline/simulate/carried_apparatus.hpp"

#include <cmath>

namespace kinectlab::simulate {
namespace {

constexpr double kDisplaceStiffness = 7.0;  ///< 1/s: there after 2 s
constexpr double kBrakeStiffness = 5.0;     ///< 1/s: away after 2.8 s
constexpr double kArrived = 14.0;  ///< stiffness x time after which 1e-5 of the way is left

/// Critically damped towards `to`; the turn that is left shrinks alike, from rest.
void carry_body(const Body& from, const Body& to, double stiffness, double t, Body& body) {
    const double fade = std::exp(-stiffness * t);
    const Eigen::Vector3d offset = from.p_lab - to.p_lab;
    const Eigen::Vector3d slope = from.v_lab + stiffness * offset;
    body.p_lab = to.p_lab + fade * (offset + t * slope);
    body.v_lab = fade * (from.v_lab - t * stiffness * slope);
    const Eigen::AngleAxisd turn(from.q_lab_body * to.q_lab_body.conjugate());
    const double left = (1.0 + stiffness * t) * fade;
    body.q_lab_body = Eigen::AngleAxisd(left * turn.angle(), turn.axis()) * to.q_lab_body;
    body.w_lab = -stiffness * stiffness * t * fade * turn.angle() * turn.axis();
}

}  // namespace

CarriedApparatus::CarriedApparatus(std::vector<Body> parked)
    : parked_(std::move(parked)), bodies_(parked_) {}

Result<void> CarriedApparatus::apply(const Command& command) {
    switch (command.action) {
        case Action::stop: {
            if (motion_ == Motion::at_rest || motion_ == Motion::braking) return {};
            std::vector<Body> away = parked_;
            for (std::size_t i = 0; i < away.size(); ++i)
                away[i].q_lab_body = bodies_[i].q_lab_body;
            carry(Motion::braking, std::move(away), kBrakeStiffness);
            value_ = 0.0;
            return {};
        }
        case Action::displace: {
            if (auto ok = check_range("value", command.value, least_value(), largest_value()); !ok)
                return ok;
            std::vector<Body> start = bodies_;
            set_up(command.value, start);
            if (motion_ == Motion::at_rest)  // out of sight they are turned at once
                for (std::size_t i = 0; i < start.size(); ++i)
                    bodies_[i].q_lab_body = start[i].q_lab_body;
            carry(Motion::moving, std::move(start), kDisplaceStiffness);
            value_ = command.value;
            held_anew_ = true;
            return {};
        }
        case Action::hold:
            if (motion_ != Motion::free) return {};
            held_anew_ = false;
            hold_here(Motion::held);
            return {};
        case Action::release:
            if (motion_ != Motion::held) return {};
            let_go(held_anew_, bodies_);
            motion_ = Motion::free;
            motion_start_s_ = t_s_;
            return {};
    }
    return fail(
        ErrorCode::invalid_argument, "action", "is unknown", "stop, displace, hold, release"
    );
}

void CarriedApparatus::advance_to(double t_s) {
    if (!(t_s > t_s_)) return;
    t_s_ = t_s;
    const double since_start = t_s_ - motion_start_s_;
    if (motion_ == Motion::free) follow(since_start, bodies_);
    if (motion_ == Motion::moving || motion_ == Motion::braking) {
        for (std::size_t i = 0; i < bodies_.size(); ++i)
            carry_body(from_[i], to_[i], stiffness_, since_start, bodies_[i]);
        if (since_start * stiffness_ >= kArrived) {
            bodies_ = to_;
            hold_here(motion_ == Motion::braking ? Motion::at_rest : Motion::held);
        }
    }
}

void CarriedApparatus::carry(Motion motion, std::vector<Body> to, double stiffness) {
    from_ = bodies_;
    to_ = std::move(to);
    stiffness_ = stiffness;
    motion_ = motion;
    motion_start_s_ = t_s_;
}

void CarriedApparatus::hold_here(Motion motion) {
    for (Body& body : bodies_) {
        body.v_lab.setZero();
        body.w_lab.setZero();
    }
    motion_ = motion;
}

}  // namespace kinectlab::simulate
