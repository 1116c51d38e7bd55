#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string_view>

#include <Eigen/Geometry>

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab::testing {

using BodyPath = std::function<Eigen::Vector3d(double t)>;

inline Eigen::Quaterniond rotation(const Eigen::Vector3d& by) {
    return by.norm() > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(by.norm(), by.normalized()))
                           : Eigen::Quaterniond::Identity();
}

/// Positions at 30 frames a second as a tracker without noise would report them, to a micrometre.
inline Trajectory moving(const std::string& name, int frames, const BodyPath& path) {
    Trajectory trajectory{name, {}};
    for (int i = 0; i < frames; ++i) {
        MotionSample sample;
        sample.t = 1'700'000'000'000'000'000 + from_seconds(i / 30.0);
        sample.status = TrackStatus::tracked;
        sample.p_lab = path(i / 30.0);
        sample.covariance = 1e-12 * Matrix6d::Identity();
        trajectory.samples.push_back(sample);
    }
    return trajectory;
}

/// Noise like a Kinect's: `across` in x and z, four times as much along the view (y), rotations by
/// `turn` (rad). `stay` is how much of it the next frame keeps.
inline void spoil(
    Trajectory& trajectory,
    unsigned seed,
    double across = 5e-4,
    double stay = 0.0,
    double turn = 0.01
) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::Matrix<double, 6, 1> sigma;
    sigma << across, 4.0 * across, across, turn, turn, turn;
    Eigen::Matrix<double, 6, 1> unit;
    for (auto& one : unit)
        one = normal(random);
    for (auto& sample : trajectory.samples) {
        for (auto& one : unit)
            one = stay * one + std::sqrt(1.0 - stay * stay) * normal(random);
        const Eigen::Matrix<double, 6, 1> off = sigma.cwiseProduct(unit);
        sample.p_lab += off.head<3>();
        sample.q_lab_obj = rotation(off.tail<3>()) * sample.q_lab_obj;
        sample.covariance = sigma.cwiseAbs2().asDiagonal();
    }
}

inline const Measurement& named(const AnalysisOutcome& outcome, std::string_view name) {
    for (const auto& m : outcome.measurements)
        if (m.name == name) return m;
    throw std::out_of_range("no measurement " + std::string(name));
}

inline bool gives(const AnalysisOutcome& outcome, std::string_view name) {
    for (const auto& m : outcome.measurements)
        if (m.name == name) return true;
    return false;
}

}  // namespace kinectlab::testing
