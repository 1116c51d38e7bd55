#include "server/rig/simulated_actuator.hpp"

#include <span>

#include "pipeline/drivers/simulated_rig/protocol.hpp"

namespace kinectlab::rig {
namespace {

namespace sim = simulated_rig;

constexpr BobMotion to_motion(sim::Motion motion) {
    switch (motion) {
        case sim::Motion::at_rest:
            return BobMotion::at_rest;
        case sim::Motion::moving_to_angle:
            return BobMotion::moving_to_angle;
        case sim::Motion::held:
            return BobMotion::held;
        case sim::Motion::swinging:
            return BobMotion::swinging;
        case sim::Motion::braking:
            return BobMotion::braking;
    }
    return BobMotion::swinging;  // unknown: assume the one that has to be stopped
}

class SimulatedActuator final : public Actuator {
public:
    explicit SimulatedActuator(OpenniSource& source) : source_(source) {}

    Result<void> configure(const lab::Parameters& parameters) override {
        sim::PendulumParameters pendulum;
        const auto take = [&](const char* name, double& value) {
            if (const auto found = parameters.find(name); found != parameters.end()) {
                value = found->second;
            }
        };
        take("length_m", pendulum.length_m);
        take("bob_radius_m", pendulum.bob_radius_m);
        take("gravity", pendulum.gravity_m_s2);
        take("latitude_deg", pendulum.latitude_deg);
        take("damping_per_s", pendulum.damping_per_s);
        return set(sim::kPendulum, pendulum, "the pendulum's parameters");
    }

    Result<void> displace(double angle_rad) override {
        return command(sim::Action::displace, angle_rad, "to move the bob");
    }
    Result<void> hold() override { return command(sim::Action::hold, 0.0, "to hold the bob"); }
    Result<void> release() override {
        return command(sim::Action::release, 0.0, "to release the bob");
    }
    Result<void> stop() override { return command(sim::Action::stop, 0.0, "to stop the bob"); }

    Result<ActuatorState> state() override {
        sim::RigState state;
        if (!source_.get_property(sim::kState, std::as_writable_bytes(std::span(&state, 1)))) {
            return fail(ErrorCode::unavailable, "actuator", "the device does not tell its state");
        }
        return ActuatorState{to_motion(state.motion), state.angle_rad};
    }

private:
    Result<void> command(sim::Action action, double angle_rad, const char* what) {
        const sim::ActuatorCommand command{.action = action, .angle_rad = angle_rad};
        return set(sim::kActuator, command, what);
    }

    template <class Value>
    Result<void> set(int property, const Value& value, const char* what) {
        if (source_.set_property(property, std::as_bytes(std::span(&value, 1)))) return {};
        return fail(ErrorCode::unavailable, "actuator", std::string("the device refused ") + what);
    }

    OpenniSource& source_;
};

}  // namespace

std::unique_ptr<Actuator> make_simulated_actuator(OpenniSource& source) {
    return std::make_unique<SimulatedActuator>(source);
}

}  // namespace kinectlab::rig
