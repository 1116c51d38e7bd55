#pragma once

#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/run/chain.hpp"
#include "pipeline/simulate/noise_model.hpp"

namespace kinectlab::bench {

/// Frames of a swinging bob with the true place of its centre.
struct SwingFrames {
    RgbdCamera camera;
    double radius_m = 0.05;
    std::vector<RgbdFrame> before;  ///< the bob at rest, displaced, and held
    std::vector<RgbdFrame> swing;
    std::vector<Eigen::Vector3d> centre_cam;  ///< one for each swing frame, m
};

struct SwingSettings {
    double distance_m = 1.6;  ///< camera to the swing plane
    double seconds = 4.0;
    simulate::NoiseModel noise = simulate::NoiseModel::khoshelham;
    std::uint64_t seed = 1;
};

[[nodiscard]] SwingFrames simulated_swing(const SwingSettings& settings);

/// A chain that tracks the bob with its radius known, and has learned the frames before.
[[nodiscard]] Chain chain_for(const SwingFrames& frames);

/// CPU time of this thread in seconds: other programs on the machine do not count.
[[nodiscard]] double thread_seconds();

}  // namespace kinectlab::bench
