#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/core/trajectory.hpp"
#include "pipeline/simulate/noise_model.hpp"

namespace kinectlab::bench {

constexpr double kTrueG = 9.81;  ///< m/s², of the runs below

/// 30 s of a swing of 10° on a metre, from rest and magnet on, rendered with the noise, tracked by
/// the chain with the bob's radius known, and turned into motion in the lab frame.
[[nodiscard]] Trajectory tracked_run(std::uint64_t seed, simulate::NoiseModel noise);

/// The same swing without a camera: the simulator's true positions with white noise, half a
/// millimetre across the view and two along it.
[[nodiscard]] Trajectory noisy_truth(std::uint64_t seed);

/// The simulated rig's length, clock and depth scale are exact, so that u is what the positions'
/// noise does, and nothing else.
[[nodiscard]] PendulumSettings exact_settings();

/// g as in a first-year course: 4π² L / T², with T the mean time between crossings of the middle.
/// Knows no amplitude; m/s².
[[nodiscard]] double small_angle_g(const Trajectory& trajectory, double length_m);

}  // namespace kinectlab::bench
