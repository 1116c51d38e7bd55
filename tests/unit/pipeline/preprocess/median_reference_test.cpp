#include "pipeline/preprocess/median_reference.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

constexpr TimeNs kFrame = kNsPerSecond / 10;

/// Its picture is no multiple of anything that loops are unrolled by.
RgbdCamera odd_camera() {
    RgbdCamera camera;
    camera.depth.width = 17;
    camera.depth.height = 19;
    return camera;
}

/// Nine pictures of a span of 0.9 s at 10 Hz: every frame is taken.
class Median : public testing::Test {
protected:
    void show(std::uint16_t depth, int frames = 1) {
        for (int i = 0; i < frames; ++i)
            median.add(std::vector<std::uint16_t>(17 * 19, depth), kFrame * now++);
        median.update();
    }
    /// Depth counts at every pixel; 0 = unknown.
    [[nodiscard]] double depth() const {
        const SceneView view = median.view();
        for (const float s : view.disparity)
            EXPECT_FLOAT_EQ(s, view.disparity[0]);
        return view.disparity[0] == 0.0F ? 0.0 : scale.product / view.disparity[0];
    }
    RgbdCamera camera = odd_camera();
    DisparityScale scale{camera};
    MedianReference median{camera, 0.9};
    TimeNs now = 100;
};

TEST_F(Median, WhatStaysForLessThanHalfTheTimeLeavesNoTrace) {
    show(3000, 5);
    show(1600, 4);
    EXPECT_NEAR(depth(), 3000, 1);
    show(1600, 2);
    EXPECT_NEAR(depth(), 1600, 1) << "it rests: now it is the scene";
}

TEST_F(Median, WhatGoesAwayIsForgottenToo) {
    show(1600, 9);
    show(3000, 4);
    EXPECT_NEAR(depth(), 1600, 1);
    show(3000, 2);
    EXPECT_NEAR(depth(), 3000, 1);
}

TEST_F(Median, PixelsWithoutReadingsMostOfTheTimeAreUnknown) {
    show(0, 5);
    show(1600, 4);
    EXPECT_EQ(depth(), 0.0);
    EXPECT_EQ(median.view().seen[0], 0);
    show(1600, 1);
    EXPECT_NEAR(depth(), 1600, 1);
    show(65535, 9);
    EXPECT_NEAR(depth(), 65535, 1) << "the farthest count is a reading";
}

TEST_F(Median, TheNoiseFallsAsOfAMean) {
    test::BallRoom room;
    room.camera = camera;
    for (int i = 0; i < 9; ++i)
        median.add(room.frame({}).depth, kFrame * now++);
    median.update();
    const double truth = scale.steps_at(room.wall_m);
    double squares = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < median.view().disparity.size(); ++i) {
        squares += std::pow(median.view().disparity[i] - truth, 2) / (17 * 19);
        variance += median.view().variance[i] / (17 * 19);
    }
    EXPECT_LT(std::sqrt(squares), 1.2 * room.sigma_steps / 3.0);
    EXPECT_NEAR(std::sqrt(variance * 9.0 / 8.0), room.sigma_steps, 0.06);
}

TEST_F(Median, TakesPicturesEvenlyInTimeAndDropsTheOld) {
    const std::vector<std::uint16_t> near(17 * 19, 1600), far(17 * 19, 3000);
    EXPECT_TRUE(median.add(near, 0));
    EXPECT_FALSE(median.add(near, kFrame / 2)) << "too soon";
    EXPECT_TRUE(median.add(near, kFrame));
    EXPECT_FALSE(median.complete(8 * kFrame));
    EXPECT_TRUE(median.complete(9 * kFrame));
    // After a pause only the last three are left, all that a slow camera may have.
    for (int i = 0; i < 2; ++i)
        EXPECT_TRUE(median.add(far, (100 + i) * kFrame));
    median.update();
    EXPECT_NEAR(depth(), 3000, 1);
    median.reset();
    EXPECT_EQ(depth(), 0.0);
    EXPECT_FALSE(median.complete(1000 * kFrame));
}

}  // namespace
}  // namespace kinectlab
