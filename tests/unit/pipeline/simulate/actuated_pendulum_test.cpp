#include "pipeline/simulate/actuated_pendulum.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace kinectlab::simulate {
namespace {

const Eigen::Vector3d kPivot(0.0, 0.0, 1.9);

ActuatedPendulum held_at(double angle_rad) {
    ActuatedPendulum pendulum(PendulumParameters{}, kPivot);
    EXPECT_TRUE(pendulum.apply({Action::displace, angle_rad}));
    pendulum.advance_to(3.0);
    return pendulum;
}

TEST(ActuatedPendulum, HangsAtRestBelowThePivot) {
    ActuatedPendulum pendulum(PendulumParameters{}, kPivot);
    pendulum.advance_to(10.0);
    EXPECT_EQ(pendulum.truth().motion, Motion::at_rest);
    EXPECT_TRUE(pendulum.truth().body().p_lab.isApprox(Eigen::Vector3d(0.0, 0.0, 0.9)));
}

TEST(ActuatedPendulum, MovesSmoothlyToItsAngleAndHoldsThere) {
    ActuatedPendulum pendulum(PendulumParameters{}, kPivot);
    ASSERT_TRUE(pendulum.apply({Action::displace, -0.3}));
    EXPECT_EQ(pendulum.truth().motion, Motion::moving);
    double last_x = 0.0;
    for (int k = 1; k <= 90; ++k) {
        pendulum.advance_to(k / 30.0);
        const double x = pendulum.truth().body().p_lab.x();
        EXPECT_LE(x, last_x + 1e-12);
        EXPECT_GT(x, last_x - 0.06);
        last_x = x;
    }
    EXPECT_EQ(pendulum.truth().motion, Motion::held);
    EXPECT_NEAR(pendulum.truth().body().p_lab.x(), -std::sin(0.3), 1e-12);
    EXPECT_NEAR(pendulum.truth().value, -0.3, 1e-12);
    EXPECT_EQ(pendulum.truth().body().v_lab.norm(), 0.0);
}

TEST(ActuatedPendulum, StartsFromRestWhenReleased) {
    ActuatedPendulum pendulum = held_at(0.2);
    ASSERT_TRUE(pendulum.apply({Action::release, 0.0}));
    EXPECT_EQ(pendulum.truth().motion, Motion::free);
    pendulum.advance_to(3.0 + 1e-3);
    EXPECT_NEAR(pendulum.truth().value, 0.2, 2e-6);
    pendulum.advance_to(4.0);
    EXPECT_LT(pendulum.truth().body().p_lab.x(), 0.0);
}

TEST(ActuatedPendulum, BrakesToRestWithinFourSeconds) {
    ActuatedPendulum pendulum = held_at(0.5);
    ASSERT_TRUE(pendulum.apply({Action::release, 0.0}));
    pendulum.advance_to(3.5);
    const Truth before = pendulum.truth();
    ASSERT_TRUE(pendulum.apply({Action::stop, 0.0}));
    pendulum.advance_to(3.5 + 1e-4);
    // Position and velocity go on without a jump.
    EXPECT_LT(
        (pendulum.truth().body().p_lab - before.body().p_lab - 1e-4 * before.body().v_lab).norm(),
        1e-6
    );
    pendulum.advance_to(7.5);
    EXPECT_EQ(pendulum.truth().motion, Motion::at_rest);
    EXPECT_TRUE(pendulum.truth().body().p_lab.isApprox(Eigen::Vector3d(0.0, 0.0, 0.9)));
}

TEST(ActuatedPendulum, HoldsWhereItIs) {
    ActuatedPendulum pendulum = held_at(0.5);
    ASSERT_TRUE(pendulum.apply({Action::release, 0.0}));
    pendulum.advance_to(3.4);
    ASSERT_TRUE(pendulum.apply({Action::hold, 0.0}));
    const Eigen::Vector3d there = pendulum.truth().body().p_lab;
    pendulum.advance_to(5.0);
    EXPECT_EQ(pendulum.truth().motion, Motion::held);
    EXPECT_EQ(pendulum.truth().body().p_lab, there);
}

TEST(ActuatedPendulum, RefusesAnglesOutOfReach) {
    ActuatedPendulum pendulum(PendulumParameters{}, kPivot);
    for (const double angle : {1.2, -1.2, std::nan("")}) {
        const auto refused = pendulum.apply({Action::displace, angle});
        ASSERT_FALSE(refused) << angle;
        EXPECT_EQ(refused.error().field, "angle_rad");
    }
    EXPECT_EQ(pendulum.truth().motion, Motion::at_rest);
}

TEST(ActuatedPendulum, IsPushedAcrossItsPlaneAtTheRelease) {
    PendulumParameters parameters;
    parameters.sideways_m_s = 0.03;
    ActuatedPendulum pendulum(parameters, kPivot);
    ASSERT_TRUE(pendulum.apply({Action::displace, 0.2}));
    pendulum.advance_to(3.0);
    ASSERT_TRUE(pendulum.apply({Action::release}));
    EXPECT_TRUE(pendulum.bodies().front().v_lab.isApprox(Eigen::Vector3d(0.0, 0.03, 0.0)));
    const double quarter = 0.5 * std::acos(-1.0) / std::sqrt(9.81);
    pendulum.advance_to(3.0 + quarter);
    EXPECT_NEAR(pendulum.bodies().front().p_lab.y(), 0.03 / std::sqrt(9.81), 2e-4);
}

}  // namespace
}  // namespace kinectlab::simulate
