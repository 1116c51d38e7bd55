#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab::testing {

/// A pendulum made for the tests alone: Newton's equation of the bob in metres with the string's
/// pull as a constraint and the whole of the Earth's turning, by fourth-order steps of half a
/// millisecond.
struct Swing {
    double g = 9.81;
    double length = 1.0;
    double bob_radius = 0.05;
    double amplitude_deg = 10.0;
    double sideways = 0.0;      ///< velocity at the release across the swing, m/s
    double damping = 0.002;     ///< 1/s
    double quadratic = 0.0;     ///< drag as the speed squared, 1/rad
    double air_share = 0.0;     ///< mass of the displaced air over the bob's
    double string_share = 0.0;  ///< mass of the string over the bob's
    double latitude_deg = 45.0;
    double seconds = 30.0;  ///< of free swing
    double rest = 0.0;      ///< s hanging still first, then drawn aside in 2 s
    double held = 0.0;      ///< s held at the amplitude
    double rate = 30.0;     ///< 1/s
    double jitter = 0.0;    ///< s, uniform to both sides
    Eigen::Vector3d pivot{0.02, 1.6, 1.3};
    unsigned jitter_seed = 1;
};

struct Bob {
    Eigen::Vector3d r;  ///< from the pivot
    Eigen::Vector3d v;
};

inline Eigen::Vector3d acceleration(const Swing& s, const Bob& b) {
    const double latitude = s.latitude_deg * std::numbers::pi / 180.0;
    const Eigen::Vector3d earth = 2.0 * std::numbers::pi / 86164.09 *
                                  Eigen::Vector3d(0.0, std::cos(latitude), std::sin(latitude));
    const double weight = 1.0 + s.string_share / 2.0 - s.air_share;
    const double inertia = 1.0 + 0.4 * s.bob_radius * s.bob_radius / (s.length * s.length) +
                           s.string_share / 3.0 + s.air_share / 2.0;
    Eigen::Vector3d a = Eigen::Vector3d(0, 0, -s.g * weight / inertia) -
                        (2.0 * s.damping + s.quadratic * b.v.norm() / s.length) * b.v -
                        2.0 * earth.cross(b.v);
    const double pull = (b.v.squaredNorm() + b.r.dot(a)) / b.r.squaredNorm();
    return a - pull * b.r;
}

inline void advance(const Swing& s, Bob& b, double time) {
    const int steps = std::max(1, static_cast<int>(std::ceil(time / 5e-4)));
    const double h = time / steps;
    for (int i = 0; i < steps; ++i) {
        const auto at = [&](const Bob& k, double f) {
            return Bob{b.r + f * k.r, b.v + f * k.v};
        };
        const auto slope = [&](const Bob& x) {
            return Bob{x.v, acceleration(s, x)};
        };
        const Bob k1 = slope(b);
        const Bob k2 = slope(at(k1, h / 2));
        const Bob k3 = slope(at(k2, h / 2));
        const Bob k4 = slope(at(k3, h));
        b.r += h / 6 * (k1.r + 2 * k2.r + 2 * k3.r + k4.r);
        b.v += h / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v);
        b.r *= s.length / b.r.norm();
    }
}

/// The bob's path as a tracker without noise would report it, to a micrometre, every sample
/// tracked.
inline Trajectory generate(const Swing& s) {
    constexpr TimeNs kStart = 1'700'000'000'000'000'000;
    std::mt19937_64 random(s.jitter_seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const double amplitude = s.amplitude_deg * std::numbers::pi / 180.0;
    const double moving = s.rest > 0.0 ? 2.0 : 0.0;
    const double release = s.rest + moving + s.held;
    const auto hanging = [&](double angle) {
        return Eigen::Vector3d(s.length * std::sin(angle), 0.0, -s.length * std::cos(angle));
    };
    Bob bob{hanging(amplitude), {0.0, s.sideways, 0.0}};
    double time = 0.0;
    Trajectory trajectory{"bob", {}};
    const int n = static_cast<int>(std::lround((release + s.seconds) * s.rate));
    for (int i = 0; i < n; ++i) {
        MotionSample m;
        double jitter = s.jitter > 0.0 ? s.jitter * uniform(random) : 0.0;
        if (i == 0) jitter = std::abs(jitter);  // not before the release
        m.t = kStart + from_seconds(i / s.rate + jitter);
        const double t = to_seconds(m.t - kStart) - release;
        Eigen::Vector3d r = hanging(amplitude);
        if (t < -s.held)
            r = hanging(
                amplitude * std::clamp((t + s.held + moving) / std::max(moving, 1e-9), 0.0, 1.0)
            );
        if (t > time) {
            advance(s, bob, t - time);
            time = t;
        }
        if (t > 0.0) r = bob.r;
        m.p_lab = s.pivot + r;
        m.covariance.topLeftCorner<3, 3>() = 1e-12 * Eigen::Matrix3d::Identity();
        m.status = TrackStatus::tracked;
        trajectory.samples.push_back(m);
    }
    return trajectory;
}

/// White noise that the covariances tell of; y of the lab is the camera's depth.
struct Noise {
    double across = 5e-4;  ///< m, x and z
    double depth = 2e-3;   ///< m, y
};

inline Trajectory with_noise(Trajectory trajectory, unsigned seed, const Noise& noise = {}) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Eigen::Vector3d sigma(noise.across, noise.depth, noise.across);
    for (auto& m : trajectory.samples) {
        for (int k = 0; k < 3; ++k)
            m.p_lab[k] += sigma[k] * normal(random);
        m.covariance.topLeftCorner<3, 3>() = sigma.cwiseAbs2().asDiagonal();
    }
    return trajectory;
}

/// Settings without any uncertainty but that of the positions, of a bob in a vacuum on a string
/// without mass.
inline PendulumSettings exact_settings(const Swing& s) {
    PendulumSettings settings;
    settings.length_m = s.length;
    settings.length_u_m = 0.0;
    settings.body = {s.bob_radius, 0.0, 0.0, 0.0};
    settings.latitude_deg = s.latitude_deg;
    settings.depth_scale_u = 0.0;
    settings.clock_u = 0.0;
    return settings;
}

/// A metre, known as a ruler tells it, and the bob of a Swing.
inline PendulumSettings usual_settings() {
    PendulumSettings settings;
    settings.length_m = 1.0;
    settings.body = {0.05, 0.0, 0.0, 0.0};
    return settings;
}

inline const Measurement& named(const PendulumResult& result, std::string_view name) {
    for (const auto& m : result.measurements)
        if (m.name == name) return m;
    throw std::out_of_range("no measurement " + std::string(name));
}

}  // namespace kinectlab::testing
