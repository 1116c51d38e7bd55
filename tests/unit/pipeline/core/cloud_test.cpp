#include "pipeline/core/cloud.hpp"

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

Pinhole tiny_camera() {
    Pinhole camera;
    camera.width = 3;
    camera.height = 2;
    camera.fx = camera.fy = 2.0;
    camera.cx = 1.0;
    camera.cy = 0.5;
    return camera;
}

TEST(Cloud, PutsEveryReadingOnItsPixelsRay) {
    RgbdFrame frame;
    frame.depth = {1000, 2000, 3000, 0, 500, 4000};
    const Pinhole camera = tiny_camera();
    const Cloud cloud = cloud_from(frame, camera);
    ASSERT_TRUE(check_shape(cloud));
    EXPECT_TRUE(cloud.organised());
    for (int v = 0; v < 2; ++v) {
        for (int u = 0; u < 3; ++u) {
            const auto i = static_cast<std::size_t>(3 * v + u);
            if (frame.depth[i] == 0) {
                EXPECT_FALSE(cloud.valid(i));
                EXPECT_TRUE(std::isnan(cloud.z[i]));
                continue;
            }
            const Eigen::Vector3d p(cloud.x[i], cloud.y[i], cloud.z[i]);
            EXPECT_NEAR(p.z(), frame.depth[i] * 0.001, 1e-6);
            EXPECT_NEAR((camera.project(p) - Eigen::Vector2d(u, v)).norm(), 0.0, 1e-5);
        }
    }
}

TEST(Cloud, TakesColourOnlyWhereItHasAsManyPixels) {
    RgbdFrame frame;
    frame.depth.assign(6, 1000);
    frame.rgb.assign(18, 7);
    EXPECT_EQ(cloud_from(frame, tiny_camera()).rgb.size(), 18U);
    frame.rgb.assign(300, 7);
    EXPECT_TRUE(cloud_from(frame, tiny_camera()).rgb.empty());
}

TEST(Cloud, SaysWhenItsArraysDoNotFit) {
    Cloud cloud = blank_cloud(3, 2);
    EXPECT_TRUE(check_shape(cloud));
    cloud.y.pop_back();
    const auto checked = check_shape(cloud);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().field, "cloud");
    EXPECT_FALSE(
        check_shape(Cloud{-1, 2, {}, {}, {}, {}}).has_value() &&
        check_shape(Cloud{-1, 2, {1.0F}, {1.0F}, {1.0F}, {}}).has_value()
    );
}

}  // namespace
}  // namespace kinectlab
