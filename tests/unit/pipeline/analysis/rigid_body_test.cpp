#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/body_generator.hpp"

namespace kinectlab::testing {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kSize(0.16, 0.10, 0.12);

struct Tumble {
    Trajectory trajectory;
    Vector3d rate;  // lab, at the start
};

/// Made from the angular momentum, which stays: q' follows from L alone, in steps of 0.1 ms.
Tumble tumbling(int frames = 180, const Vector3d& rate = {0.5, 0.4, 3.0}) {
    const Vector3d squares = kSize.cwiseAbs2();
    const Vector3d moments = Vector3d::Constant(squares.sum()) - squares;
    Quaterniond q = rotation({0.4, -0.7, 0.3});
    const Vector3d momentum = q * Vector3d(moments.cwiseProduct(rate));
    const auto lab_rate = [&](const Quaterniond& at) -> Vector3d {
        return at * Vector3d((at.conjugate() * momentum).cwiseQuotient(moments));
    };
    Tumble tumble{
        moving("box", frames, [](double t) { return Vector3d(0.1 + 0.05 * t, 1.6, 0.9); }),
        lab_rate(q)};
    const double h = 1.0 / 30.0 / 333.0;
    for (auto& sample : tumble.trajectory.samples) {
        sample.q_lab_obj = q;
        sample.has_orientation = true;
        for (int k = 0; k < 333; ++k) {
            const Quaterniond middle = rotation(h / 2 * lab_rate(q)) * q;
            q = (rotation(h * lab_rate(middle)) * q).normalized();
        }
    }
    return tumble;
}

const AnalysisSettings kBox{
    {"size_a_m", 0.16}, {"size_b_m", 0.10}, {"size_c_m", 0.12}, {"mount_u_rad", 0.001}};

void expect_rate(const AnalysisOutcome& outcome, const Vector3d& rate) {
    const char* names[] = {"rate_x", "rate_y", "rate_z"};
    for (int i = 0; i < 3; ++i) {
        const Measurement& m = named(outcome, names[i]);
        EXPECT_NEAR(m.value, rate[i], 3.5 * m.u) << names[i];
        EXPECT_GT(m.u, 0.0);
        EXPECT_LT(m.u, 0.02 * rate.norm());
        EXPECT_NEAR(m.u, combined(m.budget), 1e-12);
    }
    EXPECT_NEAR(named(outcome, "rate").value, rate.norm(), 3.5 * named(outcome, "rate").u);
}

TEST(RigidBody, FindsTheAngularVelocity) {
    Tumble tumble = tumbling();
    spoil(tumble.trajectory, 1);
    const auto outcome = analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {});
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_rate(*outcome, tumble.rate);
    EXPECT_NEAR(named(*outcome, "velocity_x").value, 0.05, 1e-3);
    EXPECT_LT(outcome->facts.at("momentum_turn_deg"), 2.0);
    EXPECT_NEAR(outcome->facts.at("energy_change_share"), 0.0, 0.05);
    EXPECT_EQ(outcome->plots.size(), 3U);
}

TEST(RigidBody, TheSignOfAQuaternionIsNothing) {
    Tumble tumble = tumbling();
    spoil(tumble.trajectory, 2);
    for (std::size_t i = 0; i < tumble.trajectory.samples.size(); i += 3)
        tumble.trajectory.samples[i].q_lab_obj.coeffs() *= -1.0;
    const auto outcome = analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {});
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_rate(*outcome, tumble.rate);
    EXPECT_EQ(outcome->facts.at("outlier_share"), 0.0);
}

TEST(RigidBody, ABoxWithoutMarksIsFollowedThroughItsLikes) {
    Tumble tumble = tumbling();
    spoil(tumble.trajectory, 3);
    const Quaterniond halves[] = {
        Quaterniond(1, 0, 0, 0),
        Quaterniond(0, 1, 0, 0),
        Quaterniond(0, 0, 1, 0),
        Quaterniond(0, 0, 0, 1)};
    std::mt19937_64 random(5);
    for (auto& s : tumble.trajectory.samples)
        s.q_lab_obj = s.q_lab_obj * halves[random() % 4];
    AnalysisSettings settings = kBox;
    settings["symmetry"] = 1.0;
    const auto outcome = analyse("rigid_body", {&tumble.trajectory, 1}, settings, {});
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_rate(*outcome, tumble.rate);
}

TEST(RigidBody, WithoutSizesFitsTheMoments) {
    Tumble tumble = tumbling(240, {1.0, 0.8, 2.5});
    spoil(tumble.trajectory, 4);
    const auto outcome = analyse("rigid_body", {&tumble.trajectory, 1}, {}, {});
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_rate(*outcome, tumble.rate);
}

TEST(RigidBody, GapsAndStraysDoNoHarm) {
    Tumble tumble = tumbling();
    spoil(tumble.trajectory, 5, 5e-4, 0.8, 0.01);
    auto& samples = tumble.trajectory.samples;
    for (std::size_t i = 60; i < 72; ++i)
        samples[i].status = TrackStatus::lost;
    for (const std::size_t i : {20U, 90U, 130U})
        samples[i].q_lab_obj = rotation({0.5, 0.5, 0.0}) * samples[i].q_lab_obj;
    const auto outcome = analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {});
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_rate(*outcome, tumble.rate);
    EXPECT_NEAR(outcome->facts.at("outlier_share"), 3.0 / 168.0, 1e-6);
}

TEST(RigidBody, RefusesWhatShowsNoTurning) {
    Tumble tumble = tumbling();
    for (auto& s : tumble.trajectory.samples)
        s.q_lab_obj.setIdentity();
    EXPECT_FALSE(analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {})) << "a constant";
    for (auto& s : tumble.trajectory.samples)
        s.has_orientation = false;
    const auto never = analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {});
    ASSERT_FALSE(never);
    EXPECT_NE(never.error().cure.find("six degrees"), std::string::npos);
    tumble = tumbling();
    tumble.trajectory.samples[5].q_lab_obj.w() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {})) << "NaN";
    tumble = tumbling(180, {10.0, 0.0, 60.0});
    EXPECT_FALSE(analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {})) << "too fast to follow";
    tumble = tumbling(8);
    EXPECT_FALSE(analyse("rigid_body", {&tumble.trajectory, 1}, kBox, {})) << "too short";
    tumble = tumbling();
    const auto half = analyse("rigid_body", {&tumble.trajectory, 1}, {{"size_a_m", 0.1}}, {});
    EXPECT_FALSE(half) << "one size of three";
}

}  // namespace
}  // namespace kinectlab::testing
