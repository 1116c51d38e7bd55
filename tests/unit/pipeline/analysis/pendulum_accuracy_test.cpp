#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

// Without noise the fit has to give back what the independent integration was made with.

namespace kinectlab::testing {
namespace {

struct Case {
    const char* name;
    Swing swing;
};

class PendulumAccuracy : public ::testing::TestWithParam<Case> {};

TEST_P(PendulumAccuracy, GivesBackGAndDamping) {
    const Swing& s = GetParam().swing;
    const auto result = analyse_pendulum(generate(s), exact_settings(s));
    ASSERT_TRUE(result) << to_text(result.error());
    EXPECT_NEAR(named(*result, "g").value / s.g, 1.0, 1e-6);
    EXPECT_NEAR(named(*result, "damping").value, s.damping, 2e-6)
        << "1e-6 at 75° is the integrator's";
    EXPECT_EQ(result->fit.outliers, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Swings,
    PendulumAccuracy,
    ::testing::Values(
        Case{"Deg3", {.amplitude_deg = 3}},
        Case{"Deg10", {.amplitude_deg = 10}},
        Case{"Deg20", {.amplitude_deg = 20}},
        Case{"Deg30", {.amplitude_deg = 30}},
        Case{"Deg60", {.amplitude_deg = 60}},
        Case{"Deg75", {.amplitude_deg = 75}},
        Case{"PointBob", {.bob_radius = 0.0}},
        Case{"BigBob", {.bob_radius = 0.12}},
        Case{"NoDamping", {.damping = 0.0}},
        Case{"HighDamping", {.damping = 0.2}},
        Case{"Short", {.length = 0.3, .bob_radius = 0.03}},
        Case{"Long", {.length = 1.5}},
        Case{"NorthPole", {.latitude_deg = 90}},
        Case{"SouthPole", {.latitude_deg = -90}},
        Case{"Ellipse", {.sideways = 0.3}},
        Case{"Circle", {.sideways = 0.5467}},
        Case{"Moon", {.g = 1.62, .seconds = 60}},
        Case{"Jupiter", {.g = 24.8}},
        Case{"Uneven", {.jitter = 0.012}},
        Case{"ThreePeriods", {.seconds = 6.5}}
    ),
    [](const auto& info) { return info.param.name; }
);

TEST(PendulumAccuracy, ReportsAmplitudePeriodsAndQuality) {
    const Swing s{.amplitude_deg = 20, .damping = 0.0};
    const auto result = analyse_pendulum(generate(s), exact_settings(s));
    ASSERT_TRUE(result);
    const double theta = 20.0 * std::numbers::pi / 180.0;
    const double small = 2.0 * std::numbers::pi * std::sqrt((1.0 + 0.4 * 0.05 * 0.05) / 9.81);
    const double series = 1.0 + std::pow(theta, 2) / 16 + 11 * std::pow(theta, 4) / 3072 +
                          173 * std::pow(theta, 6) / 737280;
    EXPECT_NEAR(named(*result, "amplitude").value, theta, 1e-6);
    EXPECT_NEAR(named(*result, "small_angle_period").value, small, 1e-6);
    EXPECT_NEAR(named(*result, "period").value, small * series, 2e-6);
    EXPECT_NEAR(
        named(*result, "turning_rate").value,
        2.0 * std::numbers::pi / 86164.09 * std::sin(std::numbers::pi / 4),
        1e-6
    );
}

TEST(PendulumAccuracy, PeriodIsTheMeanTimeBetweenCrossings) {
    const Swing s{.amplitude_deg = 25, .damping = 0.1, .seconds = 20.0, .rate = 1000.0};
    const Trajectory path = generate(s);
    std::vector<double> crossings;
    std::vector<std::size_t> after;
    for (std::size_t i = 1; i < path.samples.size(); ++i) {
        const double a = path.samples[i - 1].p_lab.x() - s.pivot.x();
        const double b = path.samples[i].p_lab.x() - s.pivot.x();
        if (a >= 0.0 || b < 0.0) continue;
        crossings.push_back(
            to_seconds(path.samples[i - 1].t - path.samples[0].t) + a / (a - b) / s.rate
        );
        after.push_back(i);
    }
    Trajectory slow{"bob", {}};  // the same time at thirty a second
    for (std::size_t i = after.front(); i <= after.back(); i += 33)
        slow.samples.push_back(path.samples[i]);
    const auto result = analyse_pendulum(slow, exact_settings(s));
    ASSERT_TRUE(result);
    const double mean =
        (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    EXPECT_NEAR(named(*result, "period").value, mean, 1e-4);
    const double small = named(*result, "small_angle_period").value;
    EXPECT_NEAR(named(*result, "quality_factor").value, std::numbers::pi / (0.1 * small), 1e-3);
}

// The fit of the few periods that it starts with knows one kind of drag only.
TEST(PendulumAccuracy, KeepsTheFirstSwingsUnderStrongDrag) {
    const Swing s{.amplitude_deg = 25, .damping = 0.01, .quadratic = 0.08, .seconds = 60};
    const auto result =
        analyse_pendulum(with_noise(generate(s), 5, {5e-4, 5e-4}), exact_settings(s));
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->warnings.empty()) << result->warnings.front();
    const Measurement& amplitude = named(*result, "amplitude");
    EXPECT_NEAR(amplitude.value, 25.0 * std::numbers::pi / 180.0, 4.0 * amplitude.u);
}

TEST(PendulumAccuracy, LeavesOutRestHandAndMagnet) {
    const Swing s{.seconds = 20.0, .rest = 3.0, .held = 2.0};
    const auto result =
        analyse_pendulum(with_noise(generate(s), 5, {1e-4, 4e-4}), exact_settings(s));
    ASSERT_TRUE(result);
    const Measurement& g = named(*result, "g");
    EXPECT_LT(std::abs(g.value - s.g), 4.0 * g.u);
    EXPECT_GE(result->fit.used, 20 * 30 - 40);
    EXPECT_LE(result->fit.used + result->fit.outliers, 20 * 30);
    EXPECT_TRUE(std::isnan(result->fit.fit_lab.front().x()))
        << "no swing is claimed where there was none";
    EXPECT_FALSE(result->warnings.empty());
}

TEST(PendulumAccuracy, FitAndResidualsStandAtTheSamplesTimes) {
    const Swing s;
    Trajectory path = generate(s);
    path.samples[100].status = TrackStatus::lost;
    path.samples[100].p_lab.setConstant(std::nan(""));
    const auto result = analyse_pendulum(path, exact_settings(s));
    ASSERT_TRUE(result);
    ASSERT_EQ(result->fit.t.size(), path.samples.size());
    EXPECT_TRUE(std::isnan(result->fit.p_lab[100].x()));
    EXPECT_TRUE(result->fit.fit_lab[100].allFinite());
    EXPECT_LT(result->fit.residual[101].norm(), 1e-6);
    EXPECT_EQ(result->fit.used, 899);
}

}  // namespace
}  // namespace kinectlab::testing
