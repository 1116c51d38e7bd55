#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "tests/bench/measurements.hpp"
#include "tests/bench/sphere_bound.hpp"
#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

struct Accuracy {
    double rms_m = 0.0;
    double bound_m = 0.0;
    double rimless_bound_m = 0.0;
};

/// Over all frames of a simulated swing with noise that is independent for each pixel.
Accuracy accuracy_at(double distance_m) {
    SwingSettings settings;
    settings.distance_m = distance_m;
    settings.seconds = 8.0;
    const SwingFrames frames = simulated_swing(settings);
    Chain chain = chain_for(frames);

    double squares = 0.0, bound = 0.0, rimless = 0.0;
    for (std::size_t i = 0; i < frames.swing.size(); ++i) {
        const auto sample = chain.track(frames.swing[i]).value().front();
        if (sample.status != TrackStatus::tracked)
            throw std::runtime_error("the bob was lost in frame " + std::to_string(i));
        squares += (sample.p_cam - frames.centre_cam[i]).squaredNorm();
        const Eigen::Vector3d& centre_cam = frames.centre_cam[i];
        bound += regular_centre_bound(frames.camera, centre_cam, frames.radius_m).trace();
        rimless += centre_bound(frames.camera, centre_cam, frames.radius_m, 0.0).trace();
    }
    const auto n = static_cast<double>(frames.swing.size());
    return {std::sqrt(squares / n), std::sqrt(bound / n), std::sqrt(rimless / n)};
}

}  // namespace

Figures measure_sphere_accuracy() {
    Figures figures;
    for (const double distance_m : {1.0, 1.6, 2.2}) {
        const Accuracy found = accuracy_at(distance_m);
        char at[16];
        std::snprintf(at, sizeof at, " at %.1f m", distance_m);
        const std::string name = "sphere centre accuracy" + std::string(at);
        const auto add = [&](const std::string& what,
                             double value,
                             std::string unit,
                             std::optional<double> bound) {
            figures.push_back({name + what, value, std::move(unit), bound, Better::lower, {}, {}});
        };
        add(", RMS over Cramér-Rao", found.rms_m / found.bound_m, "1", 1.3);
        add(", the same with every pixel of the rim", found.rms_m / found.rimless_bound_m, "1", {});
        add(", RMS", 1e3 * found.rms_m, "mm", {});
    }
    return figures;
}

}  // namespace kinectlab::bench
