#include "pipeline/track/hough.hpp"

#include <gtest/gtest.h>

#include "pipeline/track/shape_detect.hpp"
#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab {
namespace {

SurfacePoints points_of(test::ShapeRoom& room, int step) {
    DisparityImage image(room.camera);
    image.load(room.frame().depth);
    std::vector<std::uint32_t> pixels;
    for (int v = 4; v < 480; v += step)
        for (int u = 4; u < 640; u += step)
            pixels.push_back(static_cast<std::uint32_t>(v * 640 + u));
    SurfacePoints points;
    find_surface_points(image, room.camera, pixels, 4, points);
    return points;
}

TEST(Hough, FindsTheBiggestPlane) {
    test::ShapeRoom room(2);
    const Eigen::Vector3d normal = Eigen::Vector3d(0.1, -0.7, -0.7).normalized();
    room.solids = {test::wall({0, 0, 1.5}, normal), test::ball({0.1, 0, 0.9}, 0.1)};
    const SurfacePoints points = points_of(room, 12);
    std::vector<ShapeCandidate> best;
    hough_planes(points, {}, 3, best);
    ASSERT_FALSE(best.empty());
    EXPECT_LE(best.size(), 3U);
    EXPECT_GT(best[0].shape.axis.dot(normal), 0.998);
    EXPECT_NEAR(best[0].shape.axis.dot(best[0].shape.point), normal.z() * 1.5, 0.02);
}

TEST(Hough, FindsABallOfKnownAndOfUnknownRadius) {
    test::ShapeRoom room(2);
    const Eigen::Vector3d centre(0.1, 0.05, 1.1);
    room.solids = {test::ball(centre, 0.09), test::wall({0, 0, 2.0}, {0, 0.3, -1})};
    const SurfacePoints points = points_of(room, 6);
    std::vector<ShapeCandidate> best;
    hough_spheres(points, {0.09}, {3.0, 0.002, 0.1, 0.82}, 3, best);
    ASSERT_FALSE(best.empty());
    EXPECT_LT((best[0].shape.point - centre).norm(), 0.01);
    hough_spheres(points, {{}, 0.03, 0.2}, {3.0, 0.002, 0.15, 0.82}, 3, best);
    ASSERT_FALSE(best.empty());
    EXPECT_LT((best[0].shape.point - centre).norm(), 0.02);
    EXPECT_NEAR(best[0].shape.size, 0.09, 0.015);
}

TEST(Hough, FindsABallInASceneByTheRadiiThatAreTheDefault) {
    for (const double radius : {0.03, 0.05, 0.08, 0.12}) {
        test::ShapeRoom room(3);
        const Eigen::Vector3d centre(0.1, -0.05, 0.9);
        room.solids = {
            test::wall({0, 0.5, 0}, {0, -1, -0.1}),
            test::wall({0, 0, 2.8}, {0.2, 0, -1}),
            test::ball(centre, radius)};
        DisparityImage image(room.camera);
        image.load(room.frame().depth);
        const SphereSettings defaults;
        ShapeTarget target{
            0, ShapeKind::sphere, {{}, defaults.min_radius_m, defaults.max_radius_m}};
        target.in = LookIn::scene;
        target.search = GuessBy::hough;
        SegmentShapes detector(room.camera);
        const auto found = detector.in_scene(image, target);
        ASSERT_TRUE(found) << radius;
        EXPECT_LT((found->shape.point - centre).norm(), 1e-3) << radius;
        EXPECT_NEAR(found->shape.size, radius, 1e-3);

        room.solids.pop_back();
        room.changed();
        image.load(room.frame().depth);
        EXPECT_FALSE(detector.in_scene(image, target)) << "no ball is left";
        target.limits.known = radius;
        EXPECT_FALSE(detector.in_scene(image, target)) << "nor one of " << radius;
    }
}

TEST(Hough, FewPointsAreNothing) {
    std::vector<ShapeCandidate> best{{Shape{}, 1}};
    hough_planes({}, {}, 3, best);
    EXPECT_TRUE(best.empty());
    hough_spheres({}, {}, {}, 3, best);
    EXPECT_TRUE(best.empty());
}

}  // namespace
}  // namespace kinectlab
