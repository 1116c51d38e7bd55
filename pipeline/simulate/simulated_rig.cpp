#include "pipeline/simulate/simulated_rig.hpp"

#include <cmath>
#include <optional>

#include "pipeline/simulate/colour_renderer.hpp"
#include "pipeline/simulate/depth_caster.hpp"
#include "pipeline/simulate/depth_noise.hpp"

namespace kinectlab::simulate {
namespace {

Result<void> check(const CameraPlacement& placement) {
    const bool sound = placement.distance_m >= 0.6 && placement.distance_m <= 4.0 &&
                       placement.height_m >= 0.3 && placement.height_m <= 2.5 &&
                       std::abs(placement.tilt_rad) <= 0.7;
    if (sound) return {};
    return fail(
        ErrorCode::invalid_argument,
        "camera",
        "stands where it cannot see the apparatus",
        "give a distance from 0.6 to 4 m, a height from 0.3 to 2.5 m, a tilt of at most 0.7 rad"
    );
}

RgbdCamera camera_with(NoiseModel noise) {
    RgbdCamera camera = kinect_camera();
    // Rounding to millimetres is all that remains: at 1.6 m a step is 7.3 mm wide.
    if (noise == NoiseModel::none) camera.noise.sigma_steps = 0.05;
    return camera;
}

}  // namespace

struct SimulatedRig::State {
    State(const RigSettings& given, std::unique_ptr<Apparatus> made)
        : settings(given),
          camera(camera_with(given.noise)),
          T_lab_cam(T_lab_cam_of(given.camera)),
          apparatus(std::move(made)),
          room(apparatus->furniture()),
          caster(room, camera.depth, T_lab_cam),
          noise(given.noise, camera.depth, caster.empty_room()) {
        if (settings.with_colour) turn_on_colour();
    }

    void turn_on_colour() {
        colour.emplace(room, camera.colour, T_lab_cam * camera.T_colour_depth.inverse());
    }

    RigSettings settings;
    RgbdCamera camera;
    Eigen::Isometry3d T_lab_cam;
    std::unique_ptr<Apparatus> apparatus;
    Room room;
    DepthCaster caster;
    DepthNoise noise;
    std::optional<ColourRenderer> colour;
};

Result<SimulatedRig> SimulatedRig::create(const RigSettings& settings) {
    auto apparatus = make_apparatus(settings.apparatus);
    if (!apparatus) return tl::unexpected(apparatus.error());
    if (auto ok = check(settings.camera); !ok) return tl::unexpected(ok.error());
    return SimulatedRig(std::make_unique<State>(settings, std::move(*apparatus)));
}

SimulatedRig::SimulatedRig(std::unique_ptr<State> state) : state_(std::move(state)) {}
SimulatedRig::SimulatedRig(SimulatedRig&&) noexcept = default;
SimulatedRig& SimulatedRig::operator=(SimulatedRig&&) noexcept = default;
SimulatedRig::~SimulatedRig() = default;

Result<void> SimulatedRig::apply(const Command& command) {
    return state_->apparatus->apply(command);
}

void SimulatedRig::advance_to(double t_s) {
    state_->apparatus->advance_to(t_s);
}

void SimulatedRig::turn_on_colour() {
    if (!state_->colour) state_->turn_on_colour();
}

void SimulatedRig::render(RgbdFrame& frame) {
    State& s = *state_;
    const MovingParts moving{s.apparatus->bodies(), s.apparatus->wires()};
    const double t_s = s.apparatus->t_s();
    frame.index = static_cast<std::uint64_t>(std::llround(t_s * kFrameRateHz));
    frame.t = s.settings.start + from_seconds(t_s);
    const FrameRandom random(s.settings.seed, frame.index);
    s.noise.apply(s.caster.cast(moving), random, frame.depth);
    frame.t_colour = s.colour ? frame.t : 0;
    if (s.colour)
        s.colour->render(moving, random, s.settings.noise != NoiseModel::none, frame.rgb);
    else
        frame.rgb.clear();
}

Truth SimulatedRig::truth() const {
    return state_->apparatus->truth();
}
const Apparatus& SimulatedRig::apparatus() const {
    return *state_->apparatus;
}
const RgbdCamera& SimulatedRig::camera() const {
    return state_->camera;
}
const Eigen::Isometry3d& SimulatedRig::T_lab_cam() const {
    return state_->T_lab_cam;
}

}  // namespace kinectlab::simulate
