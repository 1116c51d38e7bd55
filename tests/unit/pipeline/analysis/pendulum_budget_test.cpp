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
    const auto result = analyse_pendulum(noisy_path(), {});
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
    settings.length_m += 1e-3;
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
