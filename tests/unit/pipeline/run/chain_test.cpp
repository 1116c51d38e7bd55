#include "pipeline/run/chain.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

using test::Ball;
using test::BallRoom;

ObjectSpec ball_named(std::string name, std::optional<double> radius_m = 0.05) {
    return {std::move(name), SphereSettings{.radius_m = radius_m}};
}

Chain chain_for(const BallRoom& room, std::vector<ObjectSpec> objects) {
    ChainSettings settings;
    settings.camera = room.camera;
    settings.objects = std::move(objects);
    return std::move(Chain::create(settings).value());
}

std::vector<TrackSample> track(Chain& chain, const RgbdFrame& frame) {
    const auto samples = chain.track(frame).value();
    return {samples.begin(), samples.end()};
}

TEST(Chain, RefusesFramesOfAnotherSize) {
    BallRoom room;
    Chain chain = chain_for(room, {ball_named("bob")});
    RgbdFrame wrong;
    wrong.depth.resize(320 * 240);
    EXPECT_EQ(chain.learn(wrong).error().field, "depth");
    EXPECT_EQ(chain.track(wrong).error().field, "depth");
    EXPECT_EQ(chain.learned_frames(), 0U);
}

TEST(Chain, AsksForAReferenceFirst) {
    BallRoom room;
    Chain chain = chain_for(room, {ball_named("bob")});
    EXPECT_EQ(chain.track(room.frame({})).error().code, ErrorCode::conflict);
    ASSERT_TRUE(chain.learn(room.frame({})));
    EXPECT_TRUE(chain.track(room.frame({})));
    chain.reset();
    EXPECT_FALSE(chain.track(room.frame({})));
}

TEST(Chain, RefusesACameraThatIsNone) {
    ChainSettings settings;
    settings.objects = {ball_named("bob")};
    settings.camera.depth.width = 0;
    EXPECT_EQ(Chain::create(settings).error().field, "camera");
    settings.camera = {};
    settings.camera.depth_unit_m = 0.0;
    EXPECT_EQ(Chain::create(settings).error().field, "camera");
}

TEST(Chain, NothingMovesInAnEmptyRoom) {
    BallRoom room;
    Chain chain = chain_for(room, {ball_named("bob")});
    ASSERT_TRUE(chain.learn(room.frame({})));
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(track(chain, room.frame({})).front().status, TrackStatus::lost);
}

/// The same picture again, as the n-th after a second.
const RgbdFrame& at(RgbdFrame& frame, std::size_t n) {
    frame.t = kNsPerSecond + static_cast<TimeNs>(n) * 33'333'333;
    return frame;
}

TEST(Chain, TracksABallOfFreeRadiusOnAString) {
    BallRoom room;
    room.string_above = true;
    Chain chain = chain_for(room, {ball_named("bob", std::nullopt)});
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(chain.learn(room.frame({})));
    for (int i = 0; i < 20; ++i) {
        const Ball ball{{0.015 * (i - 10), 0.03, 1.6}, 0.05};
        const auto bob = track(chain, room.frame({ball})).front();
        ASSERT_EQ(bob.status, TrackStatus::tracked) << i;
        EXPECT_LT((bob.p_cam - ball.centre_cam).norm(), 3e-3) << i;
        EXPECT_FALSE(bob.has_orientation);
        EXPECT_GT(bob.quality.points, 300);
    }
}

TEST(Chain, TheBobsRestingPlaceLeavesNoHoleInItsPath) {
    BallRoom room;
    Chain chain = chain_for(room, {ball_named("bob")});
    const Ball at_rest{{0.0, 0.0, 1.6}, 0.05};
    for (int i = 0; i < 20; ++i)
        ASSERT_TRUE(chain.learn(room.frame({at_rest})));
    EXPECT_EQ(track(chain, room.frame({at_rest})).front().status, TrackStatus::lost);
    const Ball displaced{{0.3, 0.0, 1.6}, 0.05};
    std::vector frames{room.frame({displaced}), room.frame({displaced})};
    for (std::size_t i = 0; i < 60; ++i)
        EXPECT_EQ(track(chain, at(frames[i % 2], i)).front().status, TrackStatus::tracked);
    RgbdFrame back = room.frame({at_rest});
    const auto bob = track(chain, at(back, 100)).front();  // it takes a second to hang again
    ASSERT_EQ(bob.status, TrackStatus::tracked);
    EXPECT_LT((bob.p_cam - at_rest.centre_cam).norm(), 1e-3);
}

TEST(Chain, AnObjectBeforeNothingCounts) {
    BallRoom room;
    room.wall_m = 0.0;
    Chain chain = chain_for(room, {ball_named("bob")});
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(chain.learn(room.frame({})));
    const Ball ball{{0.1, 0.0, 1.6}, 0.05};
    std::vector frames{room.frame({ball}), room.frame({ball})};
    for (std::size_t i = 0; i < 300; ++i)
        ASSERT_EQ(track(chain, at(frames[i % 2], i)).front().status, TrackStatus::tracked) << i;
}

TEST(Chain, SeveralBallsKeepTheirNames) {
    BallRoom room;
    Chain chain =
        chain_for(room, {ball_named("left"), ball_named("right"), ball_named("big", 0.09)});
    ASSERT_TRUE(chain.learn(room.frame({})));
    double last_y = 0.0;
    for (int i = 0; i < 10; ++i) {
        const std::vector<Ball> balls{
            {{-0.25 + 0.015 * i, -0.1, 1.5}, 0.05},
            {{0.25 - 0.015 * i, 0.1, 1.5}, 0.05},
            {{0.35, -0.25, 1.9}, 0.09}};
        const auto samples = track(chain, room.frame(balls));
        ASSERT_EQ(samples.size(), 3U);
        for (const auto& sample : samples)
            ASSERT_EQ(sample.status, TrackStatus::tracked) << i;
        EXPECT_NEAR(std::abs(samples[0].p_cam.y()), 0.1, 0.002);
        EXPECT_NEAR(samples[1].p_cam.y(), -samples[0].p_cam.y(), 0.004);
        EXPECT_LT((samples[2].p_cam - balls[2].centre_cam).norm(), 0.003);
        EXPECT_GE(samples[0].p_cam.y() * last_y, 0.0) << "swapped in frame " << i;
        last_y = samples[0].p_cam.y();
    }
}

TEST(Chain, ABallOfAnotherSizeIsNotTheBob) {
    BallRoom room;
    Chain chain = chain_for(room, {ball_named("bob", 0.05)});
    ASSERT_TRUE(chain.learn(room.frame({})));
    for (const double radius : {0.025, 0.1}) {
        const Ball other{{0.0, 0.0, 1.2}, radius};
        EXPECT_EQ(track(chain, room.frame({other})).front().status, TrackStatus::lost) << radius;
    }
}

TEST(Chain, AHandIsNoBob) {
    BallRoom room;
    for (const auto& radius_m : {std::optional(0.05), std::optional<double>()}) {
        Chain chain = chain_for(room, {ball_named("bob", radius_m)});
        ASSERT_TRUE(chain.learn(room.frame({})));
        for (int i = 0; i < 8; ++i) {
            // A forearm and a flat hand, slanted in depth.
            RgbdFrame frame = room.frame({});
            for (int v = 200; v < 480; ++v)
                for (int u = 250 + i; u < (v < 280 ? 330 : 300) + i; ++u) {
                    const double z = 1.3 + 0.0008 * (v - 200) + 0.0005 * (u - 250);
                    frame.depth[static_cast<std::size_t>(v * 640 + u)] = room.noisy(z);
                }
            EXPECT_EQ(track(chain, frame).front().status, TrackStatus::lost) << i;
        }
    }
}

TEST(Chain, MethodChangeGivesASampleForEachThingThatMoves) {
    BallRoom room;
    const ObjectSpec moved{"moved", ChangeTrackSettings{}};
    Chain chain = chain_for(room, {moved});
    ASSERT_TRUE(chain.learn(room.frame({})));
    EXPECT_TRUE(track(chain, room.frame({})).empty());
    const std::vector<Ball> balls{{{-0.2, 0, 1.5}, 0.05}, {{0.2, 0, 1.5}, 0.10}};
    const auto samples = track(chain, room.frame(balls));
    ASSERT_EQ(samples.size(), 2U);
    EXPECT_NEAR(samples[0].p_cam.x(), 0.2, 0.01) << "biggest first";
    EXPECT_NEAR(samples[1].p_cam.x(), -0.2, 0.01);
    EXPECT_GT(samples[1].covariance.topLeftCorner(3, 3).determinant(), 0.0);
}

}  // namespace
}  // namespace kinectlab
