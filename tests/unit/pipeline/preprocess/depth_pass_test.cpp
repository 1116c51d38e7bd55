#include "pipeline/preprocess/depth_pass.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

using test::Ball;
using test::BallRoom;

TEST(DepthPass, CutsTheWallAndKeepsTheBall) {
    BallRoom room;
    const RgbdFrame frame = room.frame({Ball{{0.1, 0.0, 1.6}, 0.1}});
    std::vector<std::uint16_t> near(frame.depth.size());
    const auto pass = pass_nearer_than_wall(frame.depth, 640, DisparityScale(room.camera), near);
    ASSERT_TRUE(pass);
    ASSERT_TRUE(pass->cut);
    for (std::size_t i = 0; i < near.size(); ++i) {
        if (frame.depth[i] < 2000) {
            EXPECT_EQ(near[i], frame.depth[i]);
        } else {
            EXPECT_EQ(near[i], 0);
        }
    }
}

TEST(DepthPass, WithoutAWallEverythingPasses) {
    BallRoom room;
    room.wall_m = 0.0;
    RgbdFrame frame = room.frame({Ball{{0.0, 0.0, 1.2}, 0.3}});
    std::vector<std::uint16_t> near(frame.depth.size());
    const auto pass = pass_nearer_than_wall(frame.depth, 640, DisparityScale(room.camera), near);
    ASSERT_TRUE(pass);
    if (!pass->cut) {
        EXPECT_EQ(near, frame.depth);
    }
    const std::vector<std::uint16_t> nothing(1000, 0);
    near.assign(1000, 7);
    const auto empty = pass_nearer_than_wall(nothing, 40, DisparityScale(room.camera), near);
    ASSERT_TRUE(empty);
    EXPECT_FALSE(empty->cut);
    EXPECT_EQ(near, nothing);
}

/// A wall that runs from 2.4 m on the left to 4.2 m on the right, and a ball nearer than its far
/// end but farther than its near one.
TEST(DepthPass, CutsASlantedWallAndKeepsWhatStandsBeforeIt) {
    BallRoom room;
    room.wall_m = 0.0;
    const Ball ball{{0.6, 0.0, 3.0}, 0.15};
    RgbdFrame frame = room.frame({ball});
    std::size_t on_ball = 0, ball_kept = 0, wall_kept = 0;
    std::vector<bool> is_ball(frame.depth.size());
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
        is_ball[i] = frame.depth[i] != 0;
        if (is_ball[i]) continue;
        const double share = static_cast<double>(i % 640) / 639.0;
        frame.depth[i] = room.noisy(1.0 / (1.0 / 2.4 + share * (1.0 / 4.2 - 1.0 / 2.4)));
    }
    std::vector<std::uint16_t> near(frame.depth.size());
    const auto pass = pass_nearer_than_wall(frame.depth, 640, DisparityScale(room.camera), near);
    ASSERT_TRUE(pass);
    ASSERT_TRUE(pass->cut);
    EXPECT_FALSE(pass->cut->level());
    for (std::size_t i = 0; i < near.size(); ++i) {
        on_ball += is_ball[i] ? 1 : 0;
        ball_kept += is_ball[i] && near[i] != 0 ? 1 : 0;
        wall_kept += !is_ball[i] && near[i] != 0 ? 1 : 0;
    }
    EXPECT_GT(ball_kept, on_ball * 95 / 100);
    EXPECT_LT(wall_kept, near.size() / 200);
}

TEST(DepthPass, RefusesAnotherSize) {
    const std::vector<std::uint16_t> depth(10, 1000);
    std::vector<std::uint16_t> near(9);
    const auto pass = pass_nearer_than_wall(depth, 5, DisparityScale(RgbdCamera{}), near);
    ASSERT_FALSE(pass);
    EXPECT_EQ(pass.error().field, "near");
    near.resize(10);
    for (const int width : {0, -5, 3, 11})
        EXPECT_EQ(
            pass_nearer_than_wall(depth, width, DisparityScale(RgbdCamera{}), near).error().field,
            "width"
        );
}

}  // namespace
}  // namespace kinectlab
