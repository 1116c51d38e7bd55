#include "tests/bench/coverage_runs.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>

namespace kinectlab::bench {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kRate = 30.0;
constexpr double kG = 9.80665;

/// Position and velocity.
struct State {
    Vector3d p = Vector3d::Zero();
    Vector3d v = Vector3d::Zero();
};

using Pull = std::function<Vector3d(const State&, double t)>;

/// By the midpoint rule in steps of 0.1 ms; recorded at 30 Hz.
class Body {
public:
    Body(State start, double from, Pull pull) : state_(start), t_(from), pull_(std::move(pull)) {}

    const State& at(double t) {
        while (t_ < t - 1e-12) {
            const double h = std::min(1e-4, t - t_);
            const State middle{state_.p + h / 2 * state_.v, state_.v + h / 2 * pull_(state_, t_)};
            state_.v += h * pull_(middle, t_ + h / 2);
            state_.p += h * middle.v;
            t_ += h;
        }
        return state_;
    }

private:
    State state_;
    double t_;
    Pull pull_;
};

class Dice {
public:
    explicit Dice(std::uint64_t seed) : random_(seed * 7919 + 17) {}
    double normal(double sigma) { return sigma * normal_(random_); }

private:
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
};

/// Everything between the truth and what a tracker reports of it.
Trajectory recorded(
    const std::vector<Vector3d>& path, Dice& dice, PositionNoise noise, const AnalysisConditions& c
) {
    const Eigen::Quaterniond tilt =
        Eigen::AngleAxisd(dice.normal(c.tilt_u_rad), Vector3d::UnitX()) *
        Eigen::AngleAxisd(dice.normal(c.tilt_u_rad), Vector3d::UnitY());
    const double scale = 1.0 + dice.normal(c.depth_scale_u);
    const double clock = 1.0 + dice.normal(c.clock_u);
    const Vector3d sigma(5e-4, 2e-3, 5e-4);
    const double lasts = noise == PositionNoise::white ? 0.0 : std::exp(-1.0 / 5.0);
    Vector3d off = Vector3d::Zero();
    Trajectory trajectory{"body", {}};
    for (std::size_t i = 0; i < path.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const double fresh = dice.normal(sigma[k]);
            off[k] = i == 0 ? fresh : lasts * off[k] + std::sqrt(1.0 - lasts * lasts) * fresh;
        }
        MotionSample sample;
        sample.t = from_seconds(1e6 + static_cast<double>(i) / kRate * clock);
        sample.status = TrackStatus::tracked;
        sample.p_lab = scale * (tilt * path[i]) + off;
        sample.covariance.topLeftCorner<3, 3>() = sigma.cwiseAbs2().asDiagonal();
        trajectory.samples.push_back(sample);
    }
    return trajectory;
}

AnalysisConditions levelled() {
    AnalysisConditions conditions;
    conditions.tilt_u_rad = 0.005;
    return conditions;
}

CoverageRun ball_on_plank(
    std::uint64_t seed, PositionNoise noise, double angle, double acceleration, bool angle_given
) {
    Dice dice(seed);
    const double drag = std::abs(dice.normal(0.02));
    const Vector3d down(std::cos(angle) * 0.8, std::cos(angle) * 0.6, -std::sin(angle));
    constexpr double kRelease = 1.012;
    constexpr double kLength = 1.5;
    Body ball({}, kRelease, [=](const State& s, double) {
        return Vector3d(down * acceleration - drag * s.v);
    });
    std::vector<Vector3d> path;
    for (double t = 0.0; path.empty() || path.back().norm() < kLength; t += 1.0 / kRate)
        path.push_back(ball.at(t).p);
    path.back() = kLength * down;
    path.insert(path.end(), 15, path.back());
    CoverageRun run;
    run.conditions = levelled();
    run.settings = {{"rolling_resistance", 0.0}, {"latitude_deg", 45.5}};
    if (angle_given) {
        run.settings["incline_u_deg"] = 0.3;
        run.settings["incline_deg"] = angle * 180.0 / pi + dice.normal(0.3);
    }
    run.trajectory = recorded(path, dice, noise, run.conditions);
    const double friction = std::tan(angle) - acceleration / kG / std::cos(angle);
    run.truth = [=](double) -> std::map<std::string, double> {
        return {
            {"acceleration", acceleration},
            {"angle", angle},
            {"g", kG},
            {"friction", friction},
            {"drag", drag}};
    };
    return run;
}

struct SpringTruth {
    double moved_mass = 0.0;
    double omega = 0.0;
    double gamma = 0.0;
    double beta = 0.0;
};

constexpr double kStiffness = 8.0;
constexpr double kMass = 0.2;
constexpr double kSpringMass = 0.02;

SpringTruth draw_spring(Dice& dice, AnalysisSettings& settings, double gamma) {
    settings = {{"mass_kg", kMass}, {"mass_u_kg", 5e-4}, {"spring_mass_kg", kSpringMass}};
    SpringTruth truth;
    truth.moved_mass = kMass + dice.normal(5e-4) + kSpringMass * (1.0 / 3.0 + dice.normal(0.01));
    truth.omega = std::sqrt(kStiffness / truth.moved_mass);
    truth.gamma = gamma;
    return truth;
}

std::map<std::string, double> results_of(const SpringTruth& s) {
    const double square = s.omega * s.omega;
    return {
        {"period", 2.0 * pi / std::sqrt(square - s.gamma * s.gamma)},
        {"angular_frequency", s.omega},
        {"stiffness", kStiffness},
        {"damping", s.gamma},
        {"quadratic_drag", s.beta},
        {"quality_factor", s.omega / (2.0 * s.gamma)},
        {"resonance_frequency", std::sqrt(square - 2.0 * s.gamma * s.gamma) / (2.0 * pi)}};
}

}  // namespace

CoverageRun thrown_ball(std::uint64_t seed, PositionNoise noise) {
    Dice dice(seed);
    constexpr double kDensity = 300.0;
    constexpr double kRadius = 0.03;
    constexpr double kAir = 1.2;
    constexpr double kRelease = 0.512;
    const double added = 1.0 + kAir / kDensity / 2.0;
    const double drag = 3.0 / 8.0 * (0.47 + dice.normal(0.05)) * kAir / kDensity / kRadius / added;
    const double g = kG * (1.0 - kAir / kDensity) / added;
    const Pull pull = [=](const State& s, double) {
        return Vector3d(-g * Vector3d::UnitZ() - drag * s.v.norm() * s.v);
    };
    const State start{{0.0, 0.1, 0.3}, {2.0, 0.3, 3.6}};
    Body ball(start, kRelease, pull);
    std::vector<Vector3d> path;
    double t = 0.0;
    for (; path.empty() || path.back().z() > 0.03; t += 1.0 / kRate)
        path.push_back(ball.at(t).p);
    State bounced = ball.at(t - 1.0 / kRate);
    bounced.v.z() *= -0.6;
    Body again(bounced, t - 1.0 / kRate, pull);
    for (int i = 0; i < 9; ++i, t += 1.0 / kRate)
        path.push_back(again.at(t).p);

    CoverageRun run;
    run.conditions = levelled();
    run.settings = {{"ball_density_kg_m3", kDensity}, {"ball_radius_m", kRadius}};
    run.trajectory = recorded(path, dice, noise, run.conditions);
    run.truth = [=](double from) -> std::map<std::string, double> {
        Body seen(start, kRelease, pull);
        const State first = seen.at(from);
        double top = from;
        while (seen.at(top).v.z() > 0.0)
            top += 1e-4;
        return {
            {"g", kG},
            {"launch_speed", first.v.norm()},
            {"elevation", std::atan2(first.v.z(), first.v.head<2>().norm())},
            {"drag", drag},
            {"rise", seen.at(top).p.z() - first.p.z()},
            {"time_to_top", top - from}};
    };
    return run;
}

CoverageRun rolling_ball(std::uint64_t seed, PositionNoise noise) {
    constexpr double kAngle = 8.0 * pi / 180.0;
    return ball_on_plank(seed, noise, kAngle, kG * std::sin(kAngle) / 1.4, false);
}

CoverageRun sliding_ball(std::uint64_t seed, PositionNoise noise) {
    constexpr double kAngle = 25.0 * pi / 180.0;
    const double a = kG * (std::sin(kAngle) - 0.08 * std::cos(kAngle));
    return ball_on_plank(seed, noise, kAngle, a, true);
}

CoverageRun free_spring(std::uint64_t seed, PositionNoise noise) {
    Dice dice(seed);
    CoverageRun run;
    SpringTruth spring = draw_spring(dice, run.settings, 0.03);
    spring.beta = std::abs(dice.normal(0.1));
    constexpr double kRelease = 1.012;
    const State start{{0.0, 0.0, -0.08}, Vector3d::Zero()};
    const Pull pull = [=](const State& s, double) {
        const double v = s.v.z();
        return Vector3d(
            0.0,
            0.0,
            -spring.omega * spring.omega * s.p.z() - 2.0 * spring.gamma * v -
                spring.beta * std::abs(v) * v
        );
    };
    Body mass(start, kRelease, pull);
    std::vector<Vector3d> path;
    for (int i = 0; i < static_cast<int>(31.0 * kRate); ++i)
        path.push_back(mass.at(i / kRate).p);
    run.trajectory = recorded(path, dice, noise, run.conditions = levelled());
    run.truth = [=](double from) {
        auto truth = results_of(spring);
        const State first = Body(start, kRelease, pull).at(from);
        const double damped = 2.0 * pi / truth["period"];
        truth["amplitude"] =
            std::hypot(first.p.z(), (first.v.z() + spring.gamma * first.p.z()) / damped);
        return truth;
    };
    return run;
}

CoverageRun driven_spring(std::uint64_t seed, PositionNoise noise) {
    Dice dice(seed);
    CoverageRun run;
    const SpringTruth spring = draw_spring(dice, run.settings, 0.1);
    run.settings["drive_hz"] = 0.9;
    run.settings["drive_u_hz"] = 0.001;
    const double drive = 2.0 * pi * (0.9 + dice.normal(0.001));
    constexpr double kForce = 0.25;  // m/s²
    Body mass({}, 0.0, [=](const State& s, double t) {
        return Vector3d(
            0.0,
            0.0,
            -spring.omega * spring.omega * s.p.z() - 2.0 * spring.gamma * s.v.z() +
                kForce * std::cos(drive * t)
        );
    });
    std::vector<Vector3d> path;
    for (int i = 0; i < static_cast<int>(40.0 * kRate); ++i)
        path.push_back(mass.at(i / kRate).p);
    run.trajectory = recorded(path, dice, noise, run.conditions = levelled());
    run.truth = [=](double) {
        auto truth = results_of(spring);
        const double stiff = spring.omega * spring.omega - drive * drive;
        const double lost = 2.0 * spring.gamma * drive;
        truth["steady_amplitude"] = kForce / std::hypot(stiff, lost);
        truth["phase_lag"] = std::atan2(lost, stiff);
        return truth;
    };
    return run;
}

}  // namespace kinectlab::bench
