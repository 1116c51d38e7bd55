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

BodyRun tumbler_run(std::uint64_t seed, BodyNoise noise) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Vector3d size(0.16, 0.10, 0.12);
    const Vector3d squares = size.cwiseAbs2();
    const Vector3d moments = Vector3d::Constant(squares.sum()) - squares;
    const double size_u = 1e-3, mount_u = 0.01;
    const Vector3d mount = mount_u * Vector3d(normal(random), normal(random), normal(random));
    const Vector3d off = size_u * Vector3d(normal(random), normal(random), normal(random));
    const Quaterniond start(
        Vector3d(normal(random), normal(random), normal(random)).norm() + 0.5, 0.3, -0.4, 0.2
    );
    const Quaterniond mounted = turned(mount, Quaterniond::Identity());  // principal in object
    Quaterniond q = start.normalized() * mounted;
    Vector3d w(0.4 + 0.1 * normal(random), 0.3, 3.0 + 0.1 * normal(random));  // principal axes
    const Vector3d p0(0.1, 1.6, 0.9), v0(0.05, -0.02, 0.03);
    BodyRun run{"rigid_body", {{"box", {}}}, {}, {}};
    const Vector3d rate = q * w;
    constexpr int kSteps = 200;
    constexpr int kFrames = 180;
    const double h = 1.0 / kRate / kSteps;
    // The middle of two small steps: second order, and the steps are 0.2 ms.
    const auto slope = [&](const Vector3d& at) -> Vector3d {
        return Vector3d(moments.cwiseProduct(at)).cross(at).cwiseQuotient(moments);
    };
    for (int i = 0; i < kFrames; ++i) {
        MotionSample sample = frame(i);
        sample.has_orientation = true;
        sample.p_lab = p0 + v0 * (i / kRate);
        sample.q_lab_obj = q * mounted.conjugate();
        run.objects.front().samples.push_back(sample);
        for (int k = 0; k < kSteps; ++k) {
            const Vector3d middle = w + h / 2 * slope(w);
            q = (q * turned(h * middle, Quaterniond::Identity())).normalized();
            w += h * slope(middle);
        }
    }
    add_noise(run.objects.front(), random, noise);
    run.settings = {
        {"size_a_m", size.x() + off.x()},
        {"size_b_m", size.y() + off.y()},
        {"size_c_m", size.z() + off.z()},
        {"size_u_m", size_u},
        {"mount_u_rad", mount_u}};
    const Vector3d mean = p0 + v0 * (0.5 * (kFrames - 1) / kRate);
    run.truth = {
        {"rate_x", rate.x()},
        {"rate_y", rate.y()},
        {"rate_z", rate.z()},
        {"rate", rate.norm()},
        {"position_x", mean.x()},
        {"position_y", mean.y()},
        {"position_z", mean.z()},
        {"velocity_x", v0.x()},
        {"velocity_y", v0.y()},
        {"velocity_z", v0.z()}};
    return run;
}

BodyRun robot_run(std::uint64_t seed, BodyNoise noise) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double phase = uniform(random), pulse = uniform(random);
    constexpr int kFrames = 600;
    constexpr int kSteps = 100;
    const double h = 1.0 / kRate / kSteps;
    Vector3d p(0.2, 1.8, 0.05);
    double heading = 2.0 * std::numbers::pi * phase;
    const double first_heading = heading;
    double length = 0.0, greatest = 0.0;
    BodyRun run{"path", {{"robot", {}}}, {}, {}};
    for (int i = 0; i < kFrames; ++i) {
        MotionSample sample = frame(i);
        sample.p_lab = p;
        run.objects.front().samples.push_back(sample);
        for (int k = 0; k < kSteps && i + 1 < kFrames; ++k) {
            const double t = (i + (k + 0.5) / kSteps) / kRate;
            const double speed = 0.3 + 0.1 * std::sin(0.7 * t + 6.0 * pulse);
            const double turning = 0.25 + 0.5 * std::sin(0.5 * t + 6.0 * phase);
            const double middle = heading + h / 2 * turning;
            p += h * speed * Vector3d(std::cos(middle), std::sin(middle), 0.0);
            heading += h * turning;
            length += h * speed;
            greatest = std::max(greatest, speed);
        }
    }
    const double duration = (kFrames - 1) / kRate;
    run.truth = {
        {"path_length", length},
        {"mean_speed", length / duration},
        {"greatest_speed", greatest},
        {"total_turn", heading - first_heading},
        {"mean_turning_rate", (heading - first_heading) / duration},
        {"displacement", (p - run.objects.front().samples.front().p_lab).norm()}};
    add_noise(run.objects.front(), random, noise);
    return run;
}

}  // namespace kinectlab::bench
