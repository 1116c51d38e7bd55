#include "tests/bench/swing_frames.hpp"

#include <stdexcept>

#include <time.h>

#include "pipeline/simulate/pendulum.hpp"
#include "pipeline/simulate/simulate_run.hpp"

namespace kinectlab::bench {

SwingFrames simulated_swing(const SwingSettings& settings) {
    simulate::RunSettings run;
    run.rig.noise = settings.noise;
    run.rig.seed = settings.seed;
    run.rig.with_colour = false;
    run.rig.camera.distance_m = settings.distance_m;
    run.seconds = settings.seconds;
    const auto rig = simulate::SimulatedRig::create(run.rig);
    if (!rig) throw std::runtime_error(to_text(rig.error()));
    const Eigen::Isometry3d T_cam_lab = rig->T_lab_cam().inverse();

    SwingFrames frames;
    frames.camera = rig->camera();
    frames.radius_m = simulate::PendulumParameters().bob_radius_m;
    const auto done = simulate::simulate_run(
        run,
        [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
            if (truth.motion == simulate::Motion::free) {
                frames.swing.push_back(frame);
                frames.centre_cam.push_back(T_cam_lab * truth.body().p_lab);
            } else {
                frames.before.push_back(frame);
            }
            return {};
        }
    );
    if (!done) throw std::runtime_error(to_text(done.error()));
    return frames;
}

Chain chain_for(const SwingFrames& frames) {
    const ObjectSpec bob{"bob", SphereSettings{.radius_m = frames.radius_m}};
    auto chain = Chain::create({frames.camera, {bob}});
    if (!chain) throw std::runtime_error(to_text(chain.error()));
    for (const auto& frame : frames.before)
        if (const auto learned = chain->learn(frame); !learned)
            throw std::runtime_error(to_text(learned.error()));
    return std::move(*chain);
}

double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace kinectlab::bench
