#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

// Without a length, and without metres.

namespace kinectlab::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

PendulumSettings without_length(const Swing& swing) {
    PendulumSettings settings = exact_settings(swing);
    settings.length_m.reset();
    return settings;
}

TEST(PendulumScale, TheArcTellsTheLength) {
    const Swing swing{.length = 0.8, .amplitude_deg = 20};
    const auto result = analyse_pendulum(with_noise(generate(swing), 2), without_length(swing));
    ASSERT_TRUE(result) << to_text(result.error());
    const auto& g = named(*result, "g");
    EXPECT_NEAR(g.value, 9.81, 0.0981);
    EXPECT_NEAR(g.value, 9.81, 3.0 * g.u);
    EXPECT_LT(g.u, 0.1);
    EXPECT_THAT(result->notes, Contains(HasSubstr("length_m was not given")));
}

TEST(PendulumScale, AFlatArcGivesNoG) {
    const Swing swing{.amplitude_deg = 1};
    const auto result = analyse_pendulum(with_noise(generate(swing), 2), without_length(swing));
    ASSERT_TRUE(result) << to_text(result.error());
    EXPECT_EQ(result->measurements.front().name, "period");
    EXPECT_NEAR(named(*result, "small_angle_period").value, 2.0071, 2e-3);
    EXPECT_THAT(result->notes, Contains(HasSubstr("too flat")));
}

/// As a program for films writes it: 700 pixels a metre, rows counted downwards.
Trajectory in_pixels(const Swing& swing) {
    Trajectory path = with_noise(generate(swing), 3);
    for (auto& m : path.samples) {
        m.p_lab = {0.7 * m.p_lab.x(), 0.0, 1.2 - 0.7 * m.p_lab.z()};
        m.covariance *= 0.49;
    }
    return path;
}

TEST(PendulumScale, PixelsGiveAllThatNeedsNoScale) {
    const Swing swing{.amplitude_deg = 12, .latitude_deg = 0.0, .seconds = 60};
    PendulumSettings settings = without_length(swing);
    settings.metric = false;
    auto result = analyse_pendulum(in_pixels(swing), settings);
    ASSERT_TRUE(result) << to_text(result.error());
    EXPECT_EQ(result->measurements.front().name, "period");
    EXPECT_NEAR(named(*result, "small_angle_period").value, 2.00707, 2e-4);
    EXPECT_NEAR(named(*result, "amplitude").value, 0.2094, 0.004);
    EXPECT_NEAR(named(*result, "damping").value, 0.002, 2e-4);
    EXPECT_THAT(result->notes, Contains(HasSubstr("pixels")));
    settings.length_m = 1.0;
    result = analyse_pendulum(in_pixels(swing), settings);
    ASSERT_TRUE(result) << to_text(result.error());
    EXPECT_NEAR(named(*result, "g").value, 9.81, 2e-3);
}

TEST(PendulumScale, HandMotionGapsAndUnevenTimes) {
    for (const double length : {0.5, 1.5}) {
        const Swing swing{
            .length = length,
            .latitude_deg = 0.0,
            .seconds = 40,
            .rest = 0.0,
            .held = 1.0,
            .jitter = 0.008};
        Trajectory path = in_pixels(swing);
        std::erase_if(path.samples, [&](const auto& m) {
            const double t = to_seconds(m.t - path.samples.front().t);
            return (t > 9.0 && t < 12.5) || (t > 21.0 && t < 23.0);
        });
        PendulumSettings settings = without_length(swing);
        settings.metric = false;
        const auto result = analyse_pendulum(path, settings);
        ASSERT_TRUE(result) << to_text(result.error());
        const double share = length * length / (length * length + 0.4 * 0.0025);
        const double small = 2.0 * std::numbers::pi * std::sqrt(length / (9.81 * share));
        EXPECT_NEAR(named(*result, "small_angle_period").value, small, 1e-3 * small);
    }
}

}  // namespace
}  // namespace kinectlab::testing
