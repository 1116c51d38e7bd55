#include "server/rig/simulated_actuator.hpp"

#include <span>

#include "pipeline/drivers/simulated_rig/protocol.hpp"
#include "pipeline/simulate/apparatus_text.hpp"

namespace kinectlab::rig {
namespace {

namespace sim = simulated_rig;

constexpr ApparatusMotion to_motion(sim::Motion motion) {
    switch (motion) {
        case sim::Motion::at_rest:
            return ApparatusMotion::at_rest;
        case sim::Motion::moving:
            return ApparatusMotion::moving;
        case sim::Motion::held:
            return ApparatusMotion::held;
        case sim::Motion::free:
            return ApparatusMotion::free;
        case sim::Motion::braking:
            return ApparatusMotion::braking;
    }
    return ApparatusMotion::free;  // unknown: assume the one that has to be stopped
}

class SimulatedActuator final : public Actuator {
public:
    explicit SimulatedActuator(OpenniSource& source) : source_(source) {}

    Result<void> configure(const std::string& apparatus, const lab::Parameters& parameters)
        override {
        const auto settings = simulate::settings_for(apparatus, parameters);
        if (!settings) return tl::unexpected(settings.error());
        // The device can only say no; why it would is found out here.
        if (const auto made = simulate::make_apparatus(*settings); !made)
            return tl::unexpected(made.error());
        const std::string text = simulate::to_text(*settings);
        return set(sim::kApparatus, std::as_bytes(std::span(text)), "the apparatus' parameters");
    }

    Result<void> displace(double value) override {
        return command(sim::Action::displace, value, "to move the apparatus to its start");
    }
    Result<void> hold() override { return command(sim::Action::hold, 0.0, "to hold"); }
    Result<void> release() override { return command(sim::Action::release, 0.0, "to release"); }
    Result<void> stop() override { return command(sim::Action::stop, 0.0, "to stop"); }

    Result<ActuatorState> state() override {
        sim::RigState state;
        if (!source_.get_property(sim::kState, std::as_writable_bytes(std::span(&state, 1)))) {
            return fail(ErrorCode::unavailable, "actuator", "the device does not tell its state");
        }
        return ActuatorState{
            to_motion(state.motion), state.value, source_.utc_of(state.motion_since_s)};
    }

private:
    Result<void> command(sim::Action action, double value, const char* what) {
        const sim::ActuatorCommand command{.action = action, .value = value};
        return set(sim::kActuator, std::as_bytes(std::span(&command, 1)), what);
    }

    Result<void> set(int property, std::span<const std::byte> value, const char* what) {
        if (source_.set_property(property, value)) return {};
        return fail(ErrorCode::unavailable, "actuator", std::string("the device refused ") + what);
    }

    OpenniSource& source_;
};

}  // namespace

std::unique_ptr<Actuator> make_simulated_actuator(OpenniSource& source) {
    return std::make_unique<SimulatedActuator>(source);
}

}  // namespace kinectlab::rig
