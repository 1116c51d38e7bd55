#include "pipeline/preprocess/reference.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

/// A small camera, so that every frame passes a pixel in few calls of follow().
RgbdCamera small_camera() {
    RgbdCamera camera;
    camera.depth.width = 16;
    camera.depth.height = 16;
    return camera;
}

std::vector<std::uint16_t> flat(std::uint16_t depth) {
    return std::vector(256, depth);
}

class Reference : public testing::Test {
protected:
    RgbdCamera camera = small_camera();
    ReferenceScene scene{camera};
    DisparityScale scale{camera};

    void follow(std::uint16_t depth, int visits) {
        for (int i = 0; i < visits * ReferenceScene::kStrips; ++i)
            scene.follow(flat(depth));
    }
    /// Depth counts of the reference, the same at every pixel; 0 = unknown.
    [[nodiscard]] double depth() const {
        for (const float s : scene.disparity())
            EXPECT_FLOAT_EQ(s, scene.disparity()[0]);
        return scene.disparity()[0] == 0.0F ? 0.0 : scale.product / scene.disparity()[0];
    }
};

TEST_F(Reference, OneFrameIsTheScene) {
    scene.learn(flat(3000));
    EXPECT_NEAR(depth(), 3000, 1);
    EXPECT_EQ(scene.learned_frames(), 1U);
}

TEST_F(Reference, UncoversOnlyWhatAnObjectHid) {
    scene.learn(flat(2000));
    for (int i = 0; i < 2; ++i)
        scene.uncover(flat(3000));
    EXPECT_NEAR(depth(), 2000, 1) << "two readings are no stable ones";
    scene.uncover(flat(3000));
    EXPECT_NEAR(depth(), 3000, 1);
    for (int i = 0; i < 5; ++i)
        scene.uncover(flat(3010));
    EXPECT_NEAR(depth(), 3000, 1) << "drift is not uncovered";
    for (int i = 0; i < 5; ++i)
        scene.uncover(flat(2000));
    EXPECT_NEAR(depth(), 3000, 1) << "nearer is an object";
    EXPECT_EQ(scene.learned_frames(), 1U);
}

TEST_F(Reference, AveragesTheNoiseOfManyFrames) {
    test::BallRoom room;
    room.camera = camera;
    ReferenceScene noisy(camera);
    for (int i = 0; i < 30; ++i)
        noisy.learn(room.frame({}).depth);
    const double truth = scale.steps_at(room.wall_m);
    double squares = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < 256; ++i) {
        squares += std::pow(noisy.disparity()[i] - truth, 2) / 256;
        variance += noisy.variance()[i] / 256;
    }
    EXPECT_LT(std::sqrt(squares), 1.5 * room.sigma_steps / std::sqrt(30.0));
    EXPECT_NEAR(std::sqrt(variance), room.sigma_steps, 0.1);
}

TEST_F(Reference, AnObjectThatComesWhileLearningIsNotTheScene) {
    for (int i = 0; i < 5; ++i)
        scene.learn(flat(3000));
    for (int i = 0; i < 50; ++i)
        scene.learn(flat(1600));
    EXPECT_NEAR(depth(), 3000, 1);
}

TEST_F(Reference, AnObjectThatLeavesWhileLearningUncoversTheScene) {
    for (int i = 0; i < 50; ++i)
        scene.learn(flat(1600));
    for (int i = 0; i < ReferenceScene::kStableHits; ++i)
        scene.learn(flat(3000));
    EXPECT_NEAR(depth(), 3000, 1);
}

TEST_F(Reference, OneWildFartherReadingIsNotBelieved) {
    for (int i = 0; i < 5; ++i)
        scene.learn(flat(1600));
    scene.learn(flat(3000));
    EXPECT_NEAR(depth(), 1600, 1);
}

TEST_F(Reference, AWildFirstReadingIsForgotten) {
    scene.learn(flat(9000));
    for (int i = 0; i < 5; ++i)
        scene.learn(flat(3000));
    EXPECT_NEAR(depth(), 3000, 1);
}

TEST_F(Reference, TheHoleOfAnObjectThatRestedClosesWhileTracking) {
    for (int i = 0; i < 30; ++i)
        scene.learn(flat(1600));
    follow(3000, ReferenceScene::kStableHits - 1);
    EXPECT_NEAR(depth(), 1600, 1);
    follow(3000, 1);
    EXPECT_NEAR(depth(), 3000, 1);
}

TEST_F(Reference, NothingNearerIsEverBelievedWhileTracking) {
    scene.learn(flat(3000));
    follow(1600, 500);
    EXPECT_NEAR(depth(), 3000, 1);
}

TEST_F(Reference, SlowDriftIsFollowed) {
    scene.learn(flat(3000));
    for (std::uint16_t depth = 3000; depth > 2700; --depth)
        follow(depth, 4);
    EXPECT_NEAR(depth(), 2700, 40);
}

TEST_F(Reference, WhatNothingIsSeenBehindIsForgottenOnceItIsGone) {
    scene.learn(flat(1600));
    follow(0, 11);
    EXPECT_NEAR(depth(), 1600, 1);
    follow(0, 1);
    EXPECT_EQ(depth(), 0.0);
    follow(1600, 100);
    EXPECT_EQ(depth(), 0.0) << "an object before nothing must not become the scene";
}

TEST_F(Reference, ResetForgetsEverything) {
    scene.learn(flat(3000));
    scene.reset();
    EXPECT_EQ(depth(), 0.0);
    EXPECT_EQ(scene.learned_frames(), 0U);
}

}  // namespace
}  // namespace kinectlab
