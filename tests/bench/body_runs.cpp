#include "tests/bench/body_runs.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Dense>

namespace kinectlab::bench {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kRate = 30.0;  // frames a second

Quaterniond turned(const Vector3d& by, const Quaterniond& q) {
    const double angle = by.norm();
    if (angle == 0.0) return q;
    return Quaterniond(Eigen::AngleAxisd(angle, by / angle)) * q;
}

/// Makes a tracker's report of true poses. y of the lab is along the view.
void add_noise(Trajectory& trajectory, std::mt19937_64& random, BodyNoise noise) {
    const bool slow = noise == BodyNoise::slow;
    const Vector3d position = slow ? Vector3d(1e-3, 5e-3, 1e-3) : Vector3d(5e-4, 2e-3, 5e-4);
    const Vector3d rotation = Vector3d::Constant(slow ? 0.015 : 0.01);
    Eigen::Matrix<double, 6, 1> sigma;
    sigma << position, rotation;
    const double stay = slow ? std::exp(-1.0 / 5.0) : 0.0;
    std::normal_distribution<double> normal;
    Eigen::Matrix<double, 6, 1> unit;
    for (auto& one : unit)
        one = normal(random);
    for (auto& sample : trajectory.samples) {
        for (auto& one : unit)
            one = stay * one + std::sqrt(1.0 - stay * stay) * normal(random);
        const Eigen::Matrix<double, 6, 1> off = sigma.cwiseProduct(unit);
        sample.p_lab += off.head<3>();
        sample.q_lab_obj = turned(off.tail<3>(), sample.q_lab_obj);
        sample.covariance = sigma.cwiseAbs2().asDiagonal();
    }
}

MotionSample frame(int i) {
    MotionSample sample;
    sample.t = 1'700'000'000'000'000'000 + from_seconds(i / kRate);
    sample.status = TrackStatus::tracked;
    return sample;
}

}  // namespace

BodyRun collision_run(std::uint64_t seed, BodyNoise noise) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double ma = 0.20, mb = 0.15, restitution = 0.9, drag = 0.05;
    const double t0 = 1.6 + uniform(random) / kRate;
    const Eigen::Vector2d slope(9.81e-3 * normal(random), 9.81e-3 * normal(random));
    const double side = 0.3 + 0.2 * uniform(random);  // rad, of the centres against the approach
    const Vector3d n(std::cos(side), std::sin(side), 0.0);
    const Vector3d va(0.5, 0.0, 0.0), vb(-0.12, 0.03, 0.0);
    const double push = (1.0 + restitution) * (va - vb).dot(n) / (1.0 / ma + 1.0 / mb);
    const Vector3d wa = va - push / ma * n, wb = vb + push / mb * n;
    const Vector3d meet(0.1, 1.5, 0.8);
    BodyRun run{"collision", {{"a", {}}, {"b", {}}}, {}, {}};
    for (int i = 0; i < 100; ++i) {
        for (std::size_t k = 0; k < 2; ++k) {
            MotionSample sample = frame(i);
            const double s = i / kRate - t0;
            const Vector3d& v = s < 0.0 ? (k == 0 ? va : vb) : (k == 0 ? wa : wb);
            const Vector3d settled(slope.x() / drag, slope.y() / drag, 0.0);
            // v' = slope - drag v, solved exactly from the impact.
            sample.p_lab = meet + (k == 0 ? Vector3d::Zero() : Vector3d(0.05 * n)) + settled * s +
                           (v - settled) * (1.0 - std::exp(-drag * s)) / drag;
            run.objects[k].samples.push_back(sample);
        }
    }
    for (auto& object : run.objects)
        add_noise(object, random, noise);
    run.settings = {{"mass_a_kg", ma}, {"mass_b_kg", mb}};
    const Vector3d e = (va - vb).normalized();
    const double before = 0.5 * (ma * va.squaredNorm() + mb * vb.squaredNorm());
    const double after = 0.5 * (ma * wa.squaredNorm() + mb * wb.squaredNorm());
    run.truth = {
        {"speed_a_before", va.norm()},
        {"speed_b_before", vb.norm()},
        {"speed_a_after", wa.norm()},
        {"speed_b_after", wb.norm()},
        {"momentum_before", (ma * va + mb * vb).dot(e)},
        {"momentum_after", (ma * va + mb * vb).dot(e)},
        {"momentum_balance", 0.0},
        {"momentum_balance_across", 0.0},
        {"energy_before", before},
        {"energy_after", after},
        {"energy_lost_share", 1.0 - after / before},
        {"restitution", restitution},
        {"impact_time", t0}};
    return run;
}

}  // namespace kinectlab::bench
