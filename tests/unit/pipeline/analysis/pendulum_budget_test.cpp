#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

namespace kinectlab::testing {
namespace {

const Swing kSwing{.amplitude_deg = 20, .seconds = 15.0};

const Trajectory& noisy_path() {
    static const Trajectory path = with_noise(generate(kSwing), 1);
    return path;
}

double line(const Measurement& m, std::string_view source) {
    for (const auto& l : m.budget)
        if (l.source == source) return l.u;
    ADD_FAILURE() << m.name << " has no line " << source;
    return -1.0;
}

TEST(PendulumBudget, LinesAddUpToU) {
    const auto result = analyse_pendulum(noisy_path(), usual_settings());
    ASSERT_TRUE(result);
    for (const auto& m : result->measurements) {
        EXPECT_NEAR(m.u, combined(m.budget), 1e-15 + 1e-12 * m.u) << m.name;
        EXPECT_GT(m.u, 0.0) << m.name;
        EXPECT_FALSE(m.unit.empty()) << m.name;
        for (const char* source : {"statistics", "length", "clock", "depth scale"})
            EXPECT_GE(line(m, source), 0.0) << m.name;
    }
}

double change_of(const char* name, const PendulumResult& a, const PendulumResult& b) {
    return std::abs(named(a, name).value - named(b, name).value);
}

TEST(PendulumBudget, WhatIsNotGivenIsALine) {
    PendulumSettings settings = exact_settings(kSwing);
    settings.body = {};
    const auto result = analyse_pendulum(noisy_path(), settings);
    ASSERT_TRUE(result);
    const auto& g = named(*result, "g");
    EXPECT_NEAR(line(g, "bob size"), g.value * 0.4 * 0.0036 / std::sqrt(3.0), 1e-5);
    EXPECT_NEAR(line(g, "air"), g.value * 1.5 * 1.2 / 600.0 / std::sqrt(3.0), 1e-5);
    EXPECT_NEAR(line(g, "string"), g.value * 0.02 / 6.0 / std::sqrt(3.0), 1e-5);
    EXPECT_NEAR(g.u, combined(g.budget), 1e-12);
    EXPECT_GE(result->notes.size(), 4U);
}

TEST(PendulumBudget, AnUnknownStringIsHeldAgainstTheBobThatIsKnown) {
    PendulumSettings settings = exact_settings(kSwing);
    const double steel = 7850.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(0.05, 3);
    settings.body = {0.05, 7850.0, {}, {}};
    const auto cord = analyse_pendulum(noisy_path(), settings);
    settings.body = {0.05, {}, 1.2, 0.002};
    const auto bob = analyse_pendulum(noisy_path(), settings);
    ASSERT_TRUE(cord && bob);
    const double root_three = std::sqrt(3.0);
    EXPECT_NEAR(line(named(*cord, "g"), "string"), 9.81 * 0.005 / steel / 6.0 / root_three, 1e-5);
    EXPECT_NEAR(line(named(*cord, "g"), "air"), 9.81 * 1.5 * 1.2 / 7850.0 / root_three, 1e-5);
    const double wood = 600.0 / 7850.0 * steel;
    EXPECT_NEAR(line(named(*bob, "g"), "string"), 9.81 * 0.002 / wood / 6.0 / root_three, 1e-5);
}

TEST(PendulumBudget, BobAirAndStringAreCorrectedFor) {
    Swing swing = kSwing;
    swing.air_share = 1.2 / 600.0;
    swing.string_share = 0.01;
    PendulumSettings settings = exact_settings(swing);
    const double mass = 600.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(0.05, 3);
    settings.body = {0.05, 600.0, 1.2, 0.01 * mass};
    const auto result = analyse_pendulum(generate(swing), settings);
    ASSERT_TRUE(result);
    EXPECT_NEAR(named(*result, "g").value, 9.81, 2e-5);
}

TEST(PendulumBudget, ClockGoesByTheFormula) {
    PendulumSettings settings = exact_settings(kSwing);
    settings.clock_u = 1e-4;
    const auto result = analyse_pendulum(noisy_path(), settings);
    ASSERT_TRUE(result);
    EXPECT_NEAR(line(named(*result, "g"), "clock"), 2 * 9.81e-4, 1e-6);
    EXPECT_NEAR(line(named(*result, "period"), "clock"), 2.02e-4, 2e-6);
    EXPECT_EQ(line(named(*result, "g"), "depth scale"), 0.0);
}

TEST(PendulumBudget, LengthLineIsWhatAWrongLengthDoes) {
    PendulumSettings settings = exact_settings(kSwing);
    settings.length_u_m = 1e-3;
    const auto right = analyse_pendulum(noisy_path(), settings);
    *settings.length_m += 1e-3;
    const auto wrong = analyse_pendulum(noisy_path(), settings);
    ASSERT_TRUE(right && wrong);
    const double line_of_g = line(named(*right, "g"), "length");
    EXPECT_NEAR(line_of_g, change_of("g", *right, *wrong), 0.02 * line_of_g);
    EXPECT_NEAR(line_of_g, 9.81e-3, 0.4e-3)
        << "g u_L / L, less what the amplitude's angle gives back";
}

TEST(PendulumBudget, DepthScaleLineIsWhatAWrongScaleDoes) {
    PendulumSettings settings = exact_settings(kSwing);
    settings.depth_scale_u = 2e-3;
    const auto right = analyse_pendulum(noisy_path(), settings);
    Trajectory scaled = noisy_path();
    for (auto& m : scaled.samples)
        m.p_lab *= 1.002;
    const auto wrong = analyse_pendulum(scaled, settings);
    ASSERT_TRUE(right && wrong);
    for (const char* name : {"g", "amplitude"}) {
        const double change = change_of(name, *right, *wrong);
        EXPECT_NEAR(line(named(*right, name), "depth scale"), change, 0.15 * change) << name;
    }
    EXPECT_LT(change_of("g", *right, *wrong), 1e-3) << "only the amplitude's correction feels it";
}

}  // namespace
}  // namespace kinectlab::testing
