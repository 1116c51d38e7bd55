#include "tests/unit/server/rig/played_rig.hpp"

namespace kinectlab::test {
namespace {

constexpr double kPeriod = 1.0 / 30.0;
constexpr std::uint16_t kWallMm = 2500;

class PlayedSource final : public FrameSource {
public:
    explicit PlayedSource(PlayedRig& rig) : rig_(rig) {
        info_.name = "played://rig?seed=1";
        if (rig_.rendered) {
            info_.camera = rig_.rendered->camera();
            info_.T_lab_cam = rig_.rendered->T_lab_cam();
        } else {
            info_.camera.depth = {64, 48, 52.5, 52.5, 31.5, 23.5};
            info_.camera.colour = info_.camera.depth;
        }
    }

    const SourceInfo& info() const override { return info_; }

    Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds timeout) override {
        if (rig_.status != FrameStatus::frame) {
            rig_.advance(std::chrono::duration<double>(timeout).count());
            return rig_.status;
        }
        const std::uint64_t step = 1 + std::exchange(rig_.skip, 0U);
        rig_.index += step;
        rig_.advance(kPeriod * static_cast<double>(step));
        if (rig_.rendered) {
            rig_.rendered->render(frame);
        } else {
            frame.depth.assign(64U * 48U, kWallMm);
            frame.rgb.assign(64U * 48U * 3U, 100);
        }
        frame.index = rig_.index;
        frame.t = rig_.now();
        frame.t_colour = frame.t;
        return FrameStatus::frame;
    }

private:
    PlayedRig& rig_;
    SourceInfo info_;
};

class PlayedActuator final : public rig::Actuator {
public:
    explicit PlayedActuator(PlayedRig& rig) : rig_(rig) {}

    Result<void> configure(const std::string&, const lab::Parameters&) override { return {}; }
    Result<void> displace(double value) override {
        return apply({simulate::Action::displace, value});
    }
    Result<void> hold() override { return apply({simulate::Action::hold}); }
    Result<void> release() override { return apply({simulate::Action::release}); }
    Result<void> stop() override {
        ++rig_.stops;
        return apply({simulate::Action::stop});
    }
    Result<rig::ActuatorState> state() override {
        const simulate::Truth truth = rig_.truth();
        return rig::ActuatorState{
            static_cast<rig::ApparatusMotion>(truth.motion), truth.value, rig_.since};
    }

private:
    Result<void> apply(const simulate::Command& command) {
        if (rig_.refusing) return fail(ErrorCode::unavailable, "actuator", "refuses");
        return rig_.deaf ? Result<void>{} : rig_.apply(command);
    }

    PlayedRig& rig_;
};

simulate::RigSettings rendered_settings(TimeNs start) {
    simulate::RigSettings settings;
    settings.with_colour = false;
    settings.start = start;
    return settings;
}

}  // namespace

PlayedRig::PlayedRig(TimeNs start_, bool with_rendering)
    : start(start_), bare(simulate::PendulumParameters{}, Eigen::Vector3d(0.0, 0.0, 1.5)) {
    if (with_rendering) {
        rendered.emplace(simulate::SimulatedRig::create(rendered_settings(start)).value());
    }
}

void PlayedRig::advance(double seconds) {
    t_s += seconds;
    bare.advance_to(t_s);
    if (rendered) rendered->advance_to(t_s);
}

Result<rig::Device> PlayedRig::open() {
    if (absent) return fail(ErrorCode::unavailable, "uri", "no such device");
    return rig::Device{
        std::make_unique<PlayedSource>(*this), std::make_unique<PlayedActuator>(*this)};
}

}  // namespace kinectlab::test
