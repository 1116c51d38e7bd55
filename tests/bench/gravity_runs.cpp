#include "tests/bench/gravity_runs.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "pipeline/motion/motion.hpp"
#include "pipeline/run/chain.hpp"
#include "pipeline/simulate/pendulum.hpp"
#include "pipeline/simulate/simulate_run.hpp"

namespace kinectlab::bench {
namespace {

constexpr double kSeconds = 30.0;
constexpr double kAmplitude = 10.0 * std::numbers::pi / 180.0;

template <class T>
T or_throw(Result<T> result) {
    if (!result) throw std::runtime_error(to_text(result.error()));
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

simulate::RunSettings run_settings(std::uint64_t seed, simulate::NoiseModel noise) {
    simulate::RunSettings run;
    run.rig.noise = noise;
    run.rig.seed = seed;
    run.rig.with_colour = false;
    run.rig.apparatus.parameters["gravity"] = kTrueG;
    run.displacement = kAmplitude;
    run.seconds = kSeconds;
    return run;
}

}  // namespace

Trajectory tracked_run(std::uint64_t seed, simulate::NoiseModel noise) {
    const simulate::RunSettings run = run_settings(seed, noise);
    const auto rig = or_throw(simulate::SimulatedRig::create(run.rig));
    const ObjectSpec bob{
        "bob", SphereSettings{.radius_m = simulate::PendulumParameters().bob_radius_m}};
    Chain chain = or_throw(Chain::create({rig.camera(), {bob}}));
    std::vector<TrackSample> samples;
    or_throw(simulate::simulate_run(
        run,
        [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
            if (truth.motion != simulate::Motion::free && truth.motion != simulate::Motion::held)
                return chain.learn(frame);
            auto found = chain.track(frame);
            if (!found) return tl::unexpected(found.error());
            samples.push_back(found->front());
            return {};
        }
    ));
    return to_trajectory("bob", samples, rig.T_lab_cam());
}

Trajectory noisy_truth(std::uint64_t seed) {
    simulate::PendulumParameters pendulum;
    pendulum.gravity_m_s2 = kTrueG;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Eigen::Vector3d sigma(5e-4, 2e-3, 5e-4);
    simulate::Swing swing(
        pendulum, {{std::sin(kAmplitude), 0.0, -std::cos(kAmplitude)}, {0.0, 0.0, 0.0}}
    );
    Trajectory trajectory{"bob", {}};
    for (int i = 0; i < static_cast<int>(kSeconds * simulate::kFrameRateHz); ++i) {
        const double t = i / simulate::kFrameRateHz;
        MotionSample sample;
        sample.t = from_seconds(t);
        sample.status = TrackStatus::tracked;
        sample.p_lab = pendulum.length_m * swing.at(t).n;
        for (int k = 0; k < 3; ++k)
            sample.p_lab[k] += sigma[k] * normal(random);
        sample.covariance.topLeftCorner<3, 3>() = sigma.cwiseAbs2().asDiagonal();
        trajectory.samples.push_back(sample);
    }
    return trajectory;
}

PendulumSettings exact_settings() {
    PendulumSettings settings;
    settings.length_m = simulate::PendulumParameters{}.length_m;
    settings.body = {simulate::PendulumParameters{}.bob_radius_m, 0.0, 0.0, 0.0};
    settings.length_u_m = 0.0;
    settings.depth_scale_u = 0.0;
    settings.clock_u = 0.0;
    return settings;
}

double small_angle_g(const Trajectory& trajectory, double length_m) {
    double middle = 0.0;
    double n = 0.0;
    for (const auto& s : trajectory.samples)
        if (s.status == TrackStatus::tracked) {
            middle += s.p_lab.x();
            n += 1.0;
        }
    middle /= n;
    std::vector<double> crossings;
    const MotionSample* before = nullptr;
    for (const auto& s : trajectory.samples) {
        if (s.status != TrackStatus::tracked) continue;
        if (before && before->p_lab.x() < middle && s.p_lab.x() >= middle) {
            const double part = (middle - before->p_lab.x()) / (s.p_lab.x() - before->p_lab.x());
            crossings.push_back(
                to_seconds(before->t - trajectory.samples.front().t) +
                part * to_seconds(s.t - before->t)
            );
        }
        before = &s;
    }
    const double period =
        (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    return 4.0 * std::numbers::pi * std::numbers::pi * length_m / (period * period);
}

}  // namespace kinectlab::bench
