#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/detail/Configuration.h>
#include <rapidcheck/detail/Results.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

// What must hold for every swing, whatever its numbers.

namespace kinectlab::testing {
namespace {

double between(double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 10001) / 10000.0;
}

Swing any_swing() {
    Swing s;
    s.amplitude_deg = between(4.0, 40.0);
    s.sideways = between(-0.2, 0.2);
    s.damping = between(0.0, 0.05);
    s.length = between(0.4, 1.5);
    s.latitude_deg = 0.0;
    s.seconds = 8.0;
    return s;
}

double g_of(const Trajectory& path, const PendulumSettings& settings) {
    const auto result = analyse_pendulum(path, settings);
    RC_ASSERT(result.has_value());
    return result->measurements.front().value;
}

/// Eight swings each: a fit under a sanitizer takes a good part of a second.
template <class Property>
void expect_always(Property property) {
    const std::string law = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    const rc::detail::TestMetadata metadata{law, law};
    rc::detail::TestParams params = rc::detail::configuration().testParams;
    params.maxSuccess = 8;
    const auto result = rc::detail::checkTestable(std::move(property), metadata, params);
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    EXPECT_TRUE(result.template is<rc::detail::SuccessResult>()) << text.str();
}

TEST(PendulumLaws, SlowingTimeByKDividesGByKSquared) {
    expect_always([] {
        const Swing s = any_swing();
        const double k = between(0.6, 1.8);
        const Trajectory path = generate(s);
        Trajectory slowed = path;
        for (auto& m : slowed.samples)
            m.t = path.samples[0].t + from_seconds(k * to_seconds(m.t - path.samples[0].t));
        RC_ASSERT(
            std::abs(
                g_of(slowed, exact_settings(s)) * k * k / g_of(path, exact_settings(s)) - 1.0
            ) < 1e-6
        );
    });
}

TEST(PendulumLaws, TurningTheLabAboutTheVerticalLeavesG) {
    expect_always([] {
        const Swing s = any_swing();
        const Trajectory path = generate(s);
        Trajectory turned = path;
        const Eigen::AngleAxisd turn(between(-3.1, 3.1), Eigen::Vector3d::UnitZ());
        for (auto& m : turned.samples)
            m.p_lab = turn * m.p_lab;
        RC_ASSERT(
            std::abs(g_of(turned, exact_settings(s)) / g_of(path, exact_settings(s)) - 1.0) < 1e-7
        );
    });
}

TEST(PendulumLaws, MovingTheLabLeavesG) {
    expect_always([] {
        const Swing s = any_swing();
        const Trajectory path = generate(s);
        Trajectory elsewhere = path;
        const Eigen::Vector3d by(between(-3, 3), between(-3, 3), between(-3, 3));
        for (auto& m : elsewhere.samples)
            m.p_lab += by;
        RC_ASSERT(
            std::abs(g_of(elsewhere, exact_settings(s)) / g_of(path, exact_settings(s)) - 1.0) <
            1e-7
        );
    });
}

TEST(PendulumLaws, AMirroredSwingHasTheSameG) {
    expect_always([] {
        const Swing s = any_swing(
        );  // on the equator: elsewhere the Earth's turning would have to be mirrored too
        const Trajectory path = generate(s);
        Trajectory mirrored = path;
        for (auto& m : mirrored.samples)
            m.p_lab.x() = -m.p_lab.x();
        RC_ASSERT(
            std::abs(g_of(mirrored, exact_settings(s)) / g_of(path, exact_settings(s)) - 1.0) < 1e-7
        );
    });
}

}  // namespace
}  // namespace kinectlab::testing
