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

TEST(PendulumBudget, LengthAndClockGoByTheFormula) {
    PendulumSettings settings = exact_settings(kSwing);
    settings.length_u_m = 1e-3;
    settings.clock_u = 1e-4;
    const auto result = analyse_pendulum(noisy_path(), settings);
    ASSERT_TRUE(result);
    const Measurement& g = named(*result, "g");
    EXPECT_NEAR(line(g, "length"), 9.81e-3, 0.1e-3) << "g u_L / L";
    EXPECT_NEAR(line(g, "clock"), 2 * 9.81e-4, 1e-6);
    EXPECT_NEAR(line(named(*result, "period"), "clock"), 2.02e-4, 2e-6);
    EXPECT_EQ(line(g, "depth scale"), 0.0);
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
    const double change = std::abs(named(*wrong, "g").value - named(*right, "g").value);
    EXPECT_NEAR(line(named(*right, "g"), "depth scale"), change, 0.15 * change);
    EXPECT_LT(change, 1e-3) << "only the amplitude's correction feels it";
    EXPECT_NEAR(line(named(*right, "amplitude"), "depth scale"), 2e-3 * 0.349, 2e-4);
}

}  // namespace
}  // namespace kinectlab::testing
