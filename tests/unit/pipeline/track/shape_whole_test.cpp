#include "pipeline/track/shape_whole.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab {
namespace {

constexpr double kRadius = 0.08, kHalfLength = 0.12;

/// A can that lies across the view before a wall or sunk in it, and the fit that is right for it.
struct CanInAWall {
    test::ShapeRoom room{3};
    ShapeFit fit;

    explicit CanInAWall(double wall_m, double middle_m) {
        const Eigen::Vector3d left(-kHalfLength, 0.0, middle_m);
        room.solids = {
            test::can(left, Eigen::Vector3d::UnitX(), kRadius, 2.0 * kHalfLength),
            test::wall({0, 0, wall_m}, {0, 0, -1})};
        fit.shape = {ShapeKind::cylinder, {0, 0, middle_m}, Eigen::Vector3d::UnitX(), kRadius};
        fit.low = -kHalfLength;
        fit.high = kHalfLength;
    }

    [[nodiscard]] bool whole(double most_sunk = 0.2) {
        DisparityImage image(room.camera);
        image.load(room.frame().depth);
        const DisparityScale scale(room.camera);
        return is_whole(fit, image, room.camera.depth, scale, 2500.0, most_sunk);
    }
};

TEST(ShapeWhole, ACanThatStandsFreeIsOne) {
    EXPECT_TRUE(CanInAWall(1.2, 0.8).whole());
    EXPECT_TRUE(CanInAWall(0.88, 0.8).whole()) << "it lies on the wall";
}

TEST(ShapeWhole, ABulgeOfAWallIsNone) {
    EXPECT_FALSE(CanInAWall(0.8, 0.87).whole()) << "a centimetre of it stands out";
    EXPECT_TRUE(CanInAWall(0.8, 0.87).whole(1.0)) << "nothing but that speaks against it";
}

TEST(ShapeWhole, WhatIsSeenThroughIsNone) {
    CanInAWall larger(1.2, 0.8);
    larger.fit.shape.size = 1.6 * kRadius;
    larger.fit.shape.point.z() += 0.6 * kRadius;  // its front is where the can's is
    EXPECT_FALSE(larger.whole());
}

}  // namespace
}  // namespace kinectlab
