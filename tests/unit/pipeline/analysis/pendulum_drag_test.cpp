#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

// Which kind of drag the positions show.

namespace kinectlab::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

bool has(const PendulumResult& result, std::string_view name) {
    return std::any_of(result.measurements.begin(), result.measurements.end(), [&](const auto& m) {
        return m.name == name;
    });
}

void expect_within(const PendulumResult& result, const char* name, double truth) {
    const auto& m = named(result, name);
    EXPECT_NEAR(m.value, truth, 3.5 * m.u) << name;
}

Result<PendulumResult> noisy(const Swing& swing) {
    return analyse_pendulum(with_noise(generate(swing), 1), exact_settings(swing));
}

TEST(PendulumDrag, Linear) {
    const auto result = noisy({.amplitude_deg = 20, .damping = 0.02, .seconds = 40});
    ASSERT_TRUE(result);
    expect_within(*result, "damping", 0.02);
    EXPECT_FALSE(has(*result, "quadratic_damping"));
    EXPECT_THAT(result->notes, Contains(HasSubstr("Drag: linear")));
}

TEST(PendulumDrag, Quadratic) {
    const auto result =
        noisy({.amplitude_deg = 20, .damping = 0.0, .quadratic = 0.08, .seconds = 40});
    ASSERT_TRUE(result);
    expect_within(*result, "quadratic_damping", 0.08);
    expect_within(*result, "g", 9.81);
    if (has(*result, "damping")) expect_within(*result, "damping", 0.0);
    EXPECT_THAT(result->notes, Contains(HasSubstr("Drag: quadratic")));
}

TEST(PendulumDrag, TheQuadraticTermKnowsThatALinearOneMayHideBesideIt) {
    const Swing swing{.amplitude_deg = 20, .damping = 3e-4, .quadratic = 0.08, .seconds = 20};
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const auto result =
            analyse_pendulum(with_noise(generate(swing), seed), exact_settings(swing));
        ASSERT_TRUE(result) << seed;
        expect_within(*result, "quadratic_damping", 0.08);
        EXPECT_LT(named(*result, "quadratic_damping").u, 2e-3) << seed;
        if (has(*result, "damping")) expect_within(*result, "damping", 3e-4);
    }
}

TEST(PendulumDrag, StrongDragIsFollowedFromTheFirstSecondOn) {
    for (const double quadratic : {0.3, 0.5}) {
        const auto result =
            noisy({.amplitude_deg = 30, .damping = 0.05, .quadratic = quadratic, .seconds = 30});
        ASSERT_TRUE(result) << to_text(result.error());
        expect_within(*result, "amplitude", 30.0 * std::numbers::pi / 180.0);
        expect_within(*result, "damping", 0.05);
        expect_within(*result, "quadratic_damping", quadratic);
        EXPECT_TRUE(result->fit.fit_lab.front().allFinite());
    }
}

TEST(PendulumDrag, Both) {
    const auto result =
        noisy({.amplitude_deg = 25, .damping = 0.01, .quadratic = 0.08, .seconds = 60});
    ASSERT_TRUE(result);
    expect_within(*result, "damping", 0.01);
    expect_within(*result, "quadratic_damping", 0.08);
    expect_within(*result, "g", 9.81);
    EXPECT_THAT(result->notes, Contains(HasSubstr("both")));
}

TEST(PendulumDrag, ThatDoesNotShowIsSaidSo) {
    const auto result = noisy({.seconds = 10});
    ASSERT_TRUE(result);
    EXPECT_THAT(result->notes, Contains(HasSubstr("does not tell linear from quadratic")));
    expect_within(*result, "damping", 0.002);
}

}  // namespace
}  // namespace kinectlab::testing
