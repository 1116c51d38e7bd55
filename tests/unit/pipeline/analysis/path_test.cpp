#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/body_generator.hpp"

namespace kinectlab::testing {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.5;  // m
constexpr double kRate = 0.6;    // rad/s

/// A robot that drives a circle to the left.
Trajectory circle(int frames = 451) {
    return moving("robot", frames, [](double t) {
        return Vector3d(kRadius * std::sin(kRate * t), 1.8 - kRadius * std::cos(kRate * t), 0.05);
    });
}

Result<AnalysisOutcome> analysed(const Trajectory& trajectory, bool metric = true) {
    AnalysisConditions conditions;
    conditions.metric = metric;
    return analyse("path", {&trajectory, 1}, {}, conditions);
}

void expect_near(const AnalysisOutcome& outcome, const char* name, double truth, double relative) {
    const Measurement& m = named(outcome, name);
    EXPECT_NEAR(m.value, truth, 3.5 * m.u) << name;
    EXPECT_LT(m.u, relative * std::abs(truth)) << name;
    EXPECT_NEAR(m.u, combined(m.budget), 1e-12) << name;
}

TEST(Path, MeasuresACircle) {
    Trajectory robot = circle();
    spoil(robot, 1);
    const auto outcome = analysed(robot);
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_near(*outcome, "path_length", 15.0 * kRate * kRadius, 0.01);
    expect_near(*outcome, "mean_speed", kRate * kRadius, 0.01);
    expect_near(*outcome, "greatest_speed", kRate * kRadius, 0.05);
    expect_near(*outcome, "mean_turning_rate", kRate, 0.02);
    expect_near(*outcome, "total_turn", 15.0 * kRate, 0.02);
    expect_near(*outcome, "displacement", 2.0 * kRadius * std::abs(std::sin(7.5 * kRate)), 0.01);
    EXPECT_NEAR(named(*outcome, "duration").value, 15.0, 1e-6);
    EXPECT_EQ(outcome->plots.size(), 5U);
    EXPECT_TRUE(outcome->plots.front().equal_axes);
}

TEST(Path, NoiseDoesNotMakeTheWayLonger) {
    Trajectory robot = circle();
    spoil(robot, 2, 3e-3);
    const auto outcome = analysed(robot);
    ASSERT_TRUE(outcome);
    expect_near(*outcome, "path_length", 15.0 * kRate * kRadius, 0.02);
    double from_dot_to_dot = 0.0;
    for (std::size_t i = 1; i < robot.samples.size(); ++i)
        from_dot_to_dot += (robot.samples[i].p_lab - robot.samples[i - 1].p_lab).norm();
    EXPECT_GT(from_dot_to_dot, 1.3 * 15.0 * kRate * kRadius) << "the naive way";
}

TEST(Path, NoiseThatLastsWidensU) {
    Trajectory white = circle();
    Trajectory slow = circle();
    spoil(white, 3, 1e-3);
    spoil(slow, 3, 1e-3, 0.82);
    const auto of_white = analysed(white);
    const auto of_slow = analysed(slow);
    ASSERT_TRUE(of_white && of_slow);
    expect_near(*of_slow, "path_length", 15.0 * kRate * kRadius, 0.02);
    EXPECT_GT(named(*of_slow, "mean_speed").u, 1.02 * named(*of_white, "mean_speed").u);
}

TEST(Path, ARobotsOwnHeadingCountsWhereItIsSeen) {
    Trajectory robot = circle();
    for (std::size_t i = 0; i < robot.samples.size(); ++i) {
        const double heading = 2.9 + kRate * static_cast<double>(i) / 30.0;  // through ±180°
        robot.samples[i].q_lab_obj = rotation({0.0, 0.0, heading});
        robot.samples[i].has_orientation = true;
    }
    spoil(robot, 4);
    const auto outcome = analysed(robot);
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_near(*outcome, "total_turn", 15.0 * kRate, 0.005);
}

TEST(Path, AGapIsAStraightLineWithItsOwnUncertainty) {
    Trajectory robot = circle();
    for (std::size_t i = 200; i < 240; ++i)
        robot.samples[i].status = TrackStatus::lost;
    spoil(robot, 5);
    const auto outcome = analysed(robot);
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    const Measurement& length = named(*outcome, "path_length");
    EXPECT_NEAR(length.value, 15.0 * kRate * kRadius, 2.0 * length.u);
    EXPECT_FALSE(outcome->warnings.empty());
}

TEST(Path, StraysAreLeftOut) {
    Trajectory robot = circle();
    spoil(robot, 6);
    for (const std::size_t i : {50U, 150U, 151U, 300U})
        robot.samples[i].p_lab += Vector3d(0.3, 0.2, 0.0);
    const auto outcome = analysed(robot);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->fits.front().outliers, 4);
    expect_near(*outcome, "path_length", 15.0 * kRate * kRadius, 0.01);
}

TEST(Path, WithoutAMetreGivesTheTurning) {
    Trajectory robot = circle();
    for (auto& s : robot.samples)
        s.p_lab *= 500.0;
    spoil(robot, 7, 0.2);
    const auto outcome = analysed(robot, false);
    ASSERT_TRUE(outcome);
    EXPECT_FALSE(gives(*outcome, "path_length"));
    EXPECT_NEAR(named(*outcome, "mean_turning_rate").value, kRate, 0.02);
}

TEST(Path, RefusesWhatDoesNotMoveOrIsNoNumber) {
    Trajectory still = moving("robot", 200, [](double) { return Vector3d(0.0, 1.8, 0.0); });
    spoil(still, 8);
    EXPECT_FALSE(analysed(still));
    Trajectory robot = circle();
    robot.samples[7].p_lab.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(analysed(robot));
    EXPECT_FALSE(analysed(circle(5)));
    EXPECT_FALSE(analysed(Trajectory{"robot", {}}));
}

}  // namespace
}  // namespace kinectlab::testing
