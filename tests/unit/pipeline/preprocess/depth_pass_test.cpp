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
    const auto pass = pass_nearer_than_wall(frame.depth, DisparityScale(room.camera), near);
    ASSERT_TRUE(pass);
    ASSERT_TRUE(pass->cut_steps);
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
    const auto pass = pass_nearer_than_wall(frame.depth, DisparityScale(room.camera), near);
    ASSERT_TRUE(pass);
    if (!pass->cut_steps) {
        EXPECT_EQ(near, frame.depth);
    }
    const std::vector<std::uint16_t> nothing(1000, 0);
    near.assign(1000, 7);
    const auto empty = pass_nearer_than_wall(nothing, DisparityScale(room.camera), near);
    ASSERT_TRUE(empty);
    EXPECT_FALSE(empty->cut_steps);
    EXPECT_EQ(near, nothing);
}

TEST(DepthPass, RefusesAnotherSize) {
    const std::vector<std::uint16_t> depth(10, 1000);
    std::vector<std::uint16_t> near(9);
    const auto pass = pass_nearer_than_wall(depth, DisparityScale(RgbdCamera{}), near);
    ASSERT_FALSE(pass);
    EXPECT_EQ(pass.error().field, "near");
}

}  // namespace
}  // namespace kinectlab
