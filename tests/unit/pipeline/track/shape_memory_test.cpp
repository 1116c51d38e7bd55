#include "pipeline/track/shape_memory.hpp"

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

constexpr TimeNs kFrame = kNsPerSecond / 30;

ShapeSighting ball(TimeNs t, const Eigen::Vector3d& p_cam, double radius = 0.05) {
    return {t, p_cam, 1e-6, radius, 0.001};
}

TEST(ShapeMemory, AThrownBallCanBeWhereItFlies) {
    ShapeMemory memory;
    const Eigen::Vector3d velocity(6.4, -4.8, 0.0);  // 8 m/s
    for (int i = 0; i < 8; ++i) {
        const double t = i / 30.0;
        const auto seen = ball(i * kFrame, t * velocity + Eigen::Vector3d(0, 4.9 * t * t, 1.5));
        ASSERT_TRUE(memory.may_be(seen)) << i;
        memory.observe(seen);
    }
    // What stops it, or throws it back, is no reason to lose it.
    const Eigen::Vector3d last = memory.place().at(7 * kFrame);
    EXPECT_TRUE(memory.may_be(ball(8 * kFrame, last)));
    EXPECT_TRUE(memory.may_be(ball(8 * kFrame, last - velocity / 60.0)));
    EXPECT_FALSE(memory.may_be(ball(8 * kFrame, last - 2.0 * velocity / 30.0)));
}

TEST(ShapeMemory, WhatIsTooFarAwayIsAnotherThingForASecond) {
    ShapeMemory memory;
    for (int i = 0; i < 5; ++i)
        memory.observe(ball(i * kFrame, {-0.6, 0, 1.5}));
    EXPECT_FALSE(memory.may_be(ball(5 * kFrame, {0.1, 0, 1.5})));
    EXPECT_TRUE(memory.may_be(ball(5 * kFrame, {-0.5, 0, 1.5})));
    EXPECT_TRUE(memory.may_be(ball(4 * kFrame + 2 * kNsPerSecond, {3.0, 0, 1.5})));
}

TEST(ShapeMemory, ARecordingThatStartsAgainHasNoPlaceYet) {
    ShapeMemory memory;
    for (int i = 0; i < 5; ++i)
        memory.observe(ball((100 + i) * kFrame, {-0.6, 0, 1.5}));
    const auto start = ball(0, {0.4, 0, 1.5});
    EXPECT_TRUE(memory.may_be(start));
    memory.observe(start);
    EXPECT_FALSE(memory.may_be(ball(kFrame, {-0.6, 0, 1.5})));
}

TEST(ShapeMemory, ASizeThatWasLearnedHoldsUntilItIsForgotten) {
    ShapeMemory memory;
    for (int i = 0; i < 5; ++i)
        memory.observe(ball(i * kFrame, {0, 0, 1.5}, 0.0517));
    for (const TimeNs t : {5 * kFrame, 60 * kNsPerSecond}) {
        EXPECT_FALSE(memory.may_be(ball(t, {0, 0, 1.5}, 0.0357)));
        EXPECT_TRUE(memory.may_be(ball(t, {0, 0, 1.5}, 0.047)));
    }
    memory.forget();
    EXPECT_TRUE(memory.may_be(ball(6 * kFrame, {0, 0, 1.5}, 0.0357)));
}

TEST(ShapeMemory, OneSightingTeachesNoSizeForGood) {
    ShapeMemory memory;
    memory.observe(ball(0, {0, 0, 1.5}, 0.2));
    EXPECT_FALSE(memory.may_be(ball(kFrame, {0, 0, 1.5}, 0.05)));
    EXPECT_TRUE(memory.may_be(ball(3 * kNsPerSecond, {0, 0, 1.5}, 0.05)));
}

}  // namespace
}  // namespace kinectlab
