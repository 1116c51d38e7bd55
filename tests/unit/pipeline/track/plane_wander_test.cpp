#include "pipeline/track/plane_wander.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

constexpr TimeNs kFrame = 33'333'333;
const Eigen::Vector3d kNormal = Eigen::Vector3d(0.3, 0.2, -1.0).normalized();

/// What is told after 200 frames of a middle that moves steadily and wanders along the plane.
double told(double wander_m, const Eigen::Vector3d& velocity_m_s, double area_m2) {
    std::mt19937 random(5);
    std::normal_distribution<> normal(0.0, wander_m);
    const Eigen::Vector3d x = kNormal.unitOrthogonal();
    const Eigen::Vector3d y = kNormal.cross(x);
    PlaneWander wander;
    double variance = 0.0;
    for (int i = 0; i < 200; ++i) {
        Eigen::Vector3d middle(0.0, 0.0, 1.5);
        middle += velocity_m_s * (i * 1e-9 * static_cast<double>(kFrame));
        if (wander_m > 0.0) middle += normal(random) * x + normal(random) * y;
        variance = wander.variance(1 + i * kFrame, middle, kNormal, area_m2);
    }
    return std::sqrt(variance);
}

TEST(PlaneWander, MeasuresHowFarTheMiddleJumps) {
    EXPECT_NEAR(told(0.010, Eigen::Vector3d::Zero(), 0.01), 0.010, 0.0025);
}

TEST(PlaneWander, ASteadyMotionIsNone) {
    EXPECT_LT(told(0.0, {0.4, 0.0, 0.0}, 0.01), 0.002);
    EXPECT_NEAR(told(0.005, {0.4, 0.0, 0.1}, 0.01), 0.005, 0.0015);
}

TEST(PlaneWander, ExpectsMoreOfALargerPlaneBeforeAnythingIsSeen) {
    PlaneWander small, large;
    const Eigen::Vector3d middle(0.0, 0.0, 1.5);
    const double of_small = small.variance(1, middle, kNormal, 0.04);
    EXPECT_GT(of_small, 0.0);
    EXPECT_NEAR(large.variance(1, middle, kNormal, 4.0), 100.0 * of_small, 1e-12);
}

TEST(PlaneWander, AGapIsNoJump) {
    PlaneWander wander;
    double variance = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double x = i < 30 ? 0.0 : 0.3;  // carried elsewhere while it was not seen
        const TimeNs t = 1 + i * kFrame + (i < 30 ? 0 : kNsPerSecond);
        variance = wander.variance(t, {x, 0.0, 1.5}, {0.0, 0.0, -1.0}, 0.01);
    }
    EXPECT_LT(std::sqrt(variance), 0.002);
}

}  // namespace
}  // namespace kinectlab
