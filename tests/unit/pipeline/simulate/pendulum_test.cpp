#include "pipeline/simulate/pendulum.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kinectlab::simulate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kStep = 1e-3;

SwingState released_at(double angle_rad) {
    SwingState state;
    state.n = {std::sin(angle_rad), 0.0, -std::cos(angle_rad)};
    return state;
}

PendulumParameters undamped() {
    PendulumParameters parameters;
    parameters.damping_per_s = 0.0;
    parameters.latitude_deg = 0.0;
    return parameters;
}

/// Time after `from` at which `watched` next changes its sign, and the state there.
struct Crossing {
    double t;
    SwingState state;
};
Crossing next_crossing(
    const PendulumEquation& equation,
    Crossing from,
    const std::function<double(const SwingState&)>& watched
) {
    from.state = equation.step(from.state, kStep);
    from.t += kStep;
    for (;;) {
        const SwingState next = equation.step(from.state, kStep);
        if (watched(from.state) * watched(next) <= 0.0) break;
        from = {from.t + kStep, next};
    }
    double low = 0.0;
    double high = kStep;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const bool before = watched(equation.step(from.state, middle)) * watched(from.state) > 0.0;
        (before ? low : high) = middle;
    }
    return {from.t + low, equation.step(from.state, low)};
}

double measured_period(const PendulumParameters& parameters, double angle_rad) {
    const PendulumEquation equation(parameters);
    const auto x = [](const SwingState& state) {
        return state.n.x();
    };
    const Crossing first = next_crossing(equation, {0.0, released_at(angle_rad)}, x);
    const Crossing half = next_crossing(equation, first, x);
    return next_crossing(equation, half, x).t - first.t;
}

/// T = 4 K(sin θ/2)/ω0, exact.
double elliptic_period(const PendulumParameters& p, double angle_rad) {
    const double r = p.bob_radius_m;
    const double w0 =
        std::sqrt(p.gravity_m_s2 * p.length_m / (p.length_m * p.length_m + 0.4 * r * r));
    return 4.0 * std::comp_ellint_1(std::sin(0.5 * angle_rad)) / w0;
}

TEST(Pendulum, SwingsWithThePeriodOfTheEllipticIntegral) {
    for (const double degrees : {1.0, 10.0, 30.0, 60.0}) {
        const double angle = degrees * kPi / 180.0;
        const double expected = elliptic_period(undamped(), angle);
        EXPECT_NEAR(measured_period(undamped(), angle) / expected, 1.0, 1e-9) << degrees;
    }
}

TEST(Pendulum, TurnsItsBobWithTheString) {
    PendulumParameters big = undamped();
    big.length_m = 0.5;
    big.bob_radius_m = 0.12;
    const double expected = elliptic_period(big, 0.05);
    EXPECT_NEAR(measured_period(big, 0.05) / expected, 1.0, 1e-9);
    const double as_a_point = 2.0 * kPi * std::sqrt(0.5 / 9.81) * (1.0 + 0.05 * 0.05 / 16.0);
    EXPECT_NEAR(expected / as_a_point, std::sqrt(1.0 + 0.4 * 0.24 * 0.24), 1e-6);
}

TEST(Pendulum, KeepsItsEnergyForFiveMinutes) {
    PendulumParameters parameters = undamped();
    parameters.latitude_deg = 50.0;
    SwingState start = released_at(kPi / 6.0);
    start.n_dot = {0.0, 0.8, 0.0};
    const PendulumEquation equation(parameters);
    const double at_bottom = equation.energy(SwingState{});
    Swing swing(parameters, start);
    const double before = equation.energy(start) - at_bottom;
    const double after = equation.energy(swing.at(300.0)) - at_bottom;
    EXPECT_NEAR(after / before, 1.0, 1e-9);
}

TEST(Pendulum, DecaysAsTheDampingSays) {
    PendulumParameters parameters = undamped();
    parameters.damping_per_s = 0.02;
    const PendulumEquation equation(parameters);
    const auto speed = [](const SwingState& state) {
        return state.n_dot.x();
    };
    const Crossing first = next_crossing(equation, {0.0, released_at(0.005)}, speed);
    Crossing last = first;
    for (int i = 0; i < 40; ++i)
        last = next_crossing(equation, last, speed);
    const double decay = std::log(first.state.n.x() / last.state.n.x()) / (last.t - first.t);
    EXPECT_NEAR(decay, 0.02, 2e-7);
}

/// Direction of the swing's long axis over one period, counter-clockwise from x seen from above.
double plane_of(Swing& swing, double from_s, double period_s) {
    double along = 0.0;
    double across = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const SwingState state = swing.at(from_s + period_s * i / 2000.0);
        along += state.n.x() * state.n.x() - state.n.y() * state.n.y();
        across += 2.0 * state.n.x() * state.n.y();
    }
    return 0.5 * std::atan2(across, along);
}

TEST(Pendulum, TurnsItsPlaneAsFoucaultSays) {
    for (const double latitude : {45.0, -30.0}) {
        PendulumParameters parameters = undamped();
        parameters.latitude_deg = latitude;
        const double angle = 0.004;
        const double period = elliptic_period(parameters, angle);
        Swing swing(parameters, released_at(angle));
        const double at_first = plane_of(swing, 0.0, period);
        const double later = plane_of(swing, 100.0 * period, period);
        const double rate = (later - at_first) / (100.0 * period);
        // Clockwise from above in the north, so negative about z.
        const double expected = -2.0 * kPi / 86164.09 * std::sin(latitude * kPi / 180.0);
        EXPECT_NEAR(rate / expected, 1.0, 1e-3) << latitude;
    }
}

TEST(Pendulum, FallsEastwards) {
    // A bob that comes down in the meridian plane is ahead of the turning Earth: east is +x.
    PendulumParameters parameters = undamped();
    const PendulumEquation equation(parameters);
    SwingState falling;
    falling.n = {0.0, 1.0, 0.0};
    falling.n_dot = {0.0, 0.0, -1.0};
    EXPECT_GT(equation.acceleration(falling).x(), 0.0);
}

RC_GTEST_PROP(Pendulum, DoesNotDependOnHowOftenItIsAsked, ()) {
    const auto pauses = *rc::gen::container<std::vector<int>>(12, rc::gen::inRange(0, 5000));
    Swing often(PendulumParameters{}, released_at(0.3));
    double t = 0.0;
    for (const int pause : pauses) {
        t += 1e-4 * pause;
        static_cast<void>(often.at(t));
    }
    Swing once(PendulumParameters{}, released_at(0.3));
    RC_ASSERT(often.at(t).n == once.at(t).n);
}

TEST(Pendulum, NamesTheParameterThatIsWrong) {
    PendulumParameters parameters;
    EXPECT_TRUE(check(parameters));
    parameters.length_m = -1.0;
    ASSERT_FALSE(check(parameters));
    EXPECT_EQ(check(parameters).error().field, "length_m");
    parameters = {};
    parameters.latitude_deg = std::nan("");
    ASSERT_FALSE(check(parameters));
    EXPECT_EQ(check(parameters).error().field, "latitude_deg");
}

TEST(Pendulum, AirAndStringChangeThePeriodAsTheTablesSay) {
    const PendulumParameters bare = undamped();
    PendulumParameters aired = bare;
    aired.bob_density_kg_m3 = 500.0;
    aired.air_density_kg_m3 = 1.2;
    const double plain = measured_period(bare, 0.01);
    const double air = 1.2 / 500.0;
    const double extended = 1.0 + 0.4 * 0.05 * 0.05;  // (L² + 2/5 r²)/L² for L = 1 m
    EXPECT_NEAR(
        measured_period(aired, 0.01) / plain,
        std::sqrt((1.0 + 0.5 * air / extended) / (1.0 - air)),
        1e-8
    );
    PendulumParameters roped = bare;
    roped.bob_density_kg_m3 = 7800.0;
    roped.string_mass_kg = 0.02;
    const double mass = 7800.0 * 4.0 / 3.0 * kPi * std::pow(0.05, 3);
    const double share = 0.02 / mass;
    EXPECT_NEAR(measured_period(roped, 0.01) / plain, 1.0 - share / 12.0, 2.0 * share * share);
}

TEST(Pendulum, QuadraticDragTakesEnergyWithTheCubeOfSpeed) {
    PendulumParameters parameters = undamped();
    parameters.quadratic_damping_per_rad = 0.05;
    const PendulumEquation equation(parameters);
    SwingState state = released_at(0.3);
    for (int i = 0; i < 300; ++i)
        state = equation.step(state, kStep);
    const double before = equation.energy(state);
    const double rate = state.n_dot.norm();
    const SwingState next = equation.step(state, 1e-5);
    EXPECT_NEAR((equation.energy(next) - before) / 1e-5, -0.05 * rate * rate * rate, 1e-5);
}

}  // namespace
}  // namespace kinectlab::simulate
