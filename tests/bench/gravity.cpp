#include <algorithm>
#include <cmath>
#include <future>
#include <stdexcept>
#include <vector>

#include "tests/bench/gravity_runs.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kSeeds = 60;

struct Run {
    double error = 0.0;  // of g, m/s²
    double u = 0.0;
    double peer_error = 0.0;
};

Run analysed(const Trajectory& trajectory) {
    const PendulumSettings settings = exact_settings();
    const auto result = analyse_pendulum(trajectory, settings);
    if (!result) throw std::runtime_error(to_text(result.error()));
    const kinectlab::Measurement& g = result->measurements.front();
    return {g.value - kTrueG, g.u, small_angle_g(trajectory, *settings.length_m) - kTrueG};
}

/// Two seeds at once.
template <class Make>
std::vector<Run> over_seeds(Make make) {
    std::vector<Run> runs(kSeeds);
    const auto every_second = [&](int first) {
        for (int i = first; i < kSeeds; i += 2)
            runs[static_cast<std::size_t>(i)] = analysed(make(static_cast<std::uint64_t>(i + 1)));
    };
    auto other = std::async(std::launch::async, every_second, 1);
    every_second(0);
    other.get();
    return runs;
}

Figures summary(const std::string& name, const std::vector<Run>& runs) {
    double mean = 0.0, peer = 0.0, u = 0.0, squares = 0.0, worst = 0.0;
    for (const Run& run : runs) {
        mean += run.error / kSeeds;
        peer += run.peer_error / kSeeds;
        u += run.u / kSeeds;
        worst = std::max(worst, std::abs(run.error) / run.u);
    }
    for (const Run& run : runs)
        squares += (run.error - mean) * (run.error - mean);
    const double scatter = std::sqrt(squares / (kSeeds - 1));
    const double factor = std::max(u / scatter, scatter / u);
    const std::string peer_name = "4π²L/T² from crossings";
    return {
        {"g, " + name + ", mean error",
         std::abs(mean),
         "m/s²",
         1e-3,
         Better::lower,
         std::abs(peer),
         peer_name},
        {"g, " + name + ", largest error over u", worst, "1", 3.5, Better::lower, {}, {}},
        {"g, " + name + ", u against scatter (factor)", factor, "1", 1.5, Better::lower, {}, {}},
        {"g, " + name + ", scatter", scatter, "m/s²", {}, Better::lower, {}, {}},
        {"g, " + name + ", mean u", u, "m/s²", {}, Better::lower, {}, {}},
    };
}

}  // namespace

Figures measure_gravity_kinect() {
    return summary("kinect noise", over_seeds([](auto seed) {
                       return tracked_run(seed, simulate::NoiseModel::kinect);
                   }));
}

Figures measure_gravity_khoshelham() {
    return summary("khoshelham noise", over_seeds([](auto seed) {
                       return tracked_run(seed, simulate::NoiseModel::khoshelham);
                   }));
}

Figures measure_gravity_from_positions() {
    Figures figures = summary("white positions", over_seeds(noisy_truth));
    const Trajectory trajectory = noisy_truth(1);
    constexpr int kTimes = 10;
    const double before = thread_seconds();
    for (int i = 0; i < kTimes; ++i)
        analysed(trajectory);
    figures.push_back(
        {"g, analysis of 900 positions",
         (thread_seconds() - before) / kTimes * 1e3,
         "ms",
         50.0,
         Better::lower,
         {},
         {}}
    );
    return figures;
}

}  // namespace kinectlab::bench
