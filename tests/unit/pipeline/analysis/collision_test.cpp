#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/body_generator.hpp"

namespace kinectlab::testing {
namespace {

using Eigen::Vector3d;

constexpr double kImpact = 1.617;

/// Two discs; the second rests, the first meets it head on.
std::vector<Trajectory> head_on(double restitution = 0.8, int first = 0, int last = 95) {
    const double ma = 0.2, mb = 0.1, v = 0.5;
    const double push = (1.0 + restitution) * v / (1.0 / ma + 1.0 / mb);
    std::vector<Trajectory> balls{
        moving(
            "a",
            last,
            [&](double t) {
                const double s = t - kImpact;
                return Vector3d(s * (s < 0.0 ? v : v - push / ma), 1.5, 0.8);
            }
        ),
        moving("b", last, [&](double t) {
            const double s = t - kImpact;
            return Vector3d(0.05 + (s < 0.0 ? 0.0 : s * push / mb), 1.5, 0.8);
        })};
    for (auto& ball : balls)
        ball.samples.erase(ball.samples.begin(), ball.samples.begin() + first);
    return balls;
}

Result<AnalysisOutcome> analysed(
    std::vector<Trajectory> balls, double across = 5e-4, double stay = 0.0, bool metric = true
) {
    unsigned seed = 1;
    for (auto& ball : balls)
        spoil(ball, seed++, across, stay);
    AnalysisConditions conditions;
    conditions.metric = metric;
    return analyse("collision", balls, {{"mass_a_kg", 0.2}, {"mass_b_kg", 0.1}}, conditions);
}

void expect_near(const AnalysisOutcome& outcome, const char* name, double truth) {
    const Measurement& m = named(outcome, name);
    EXPECT_NEAR(m.value, truth, 3.5 * m.u) << name;
    EXPECT_GT(m.u, 0.0) << name;
    EXPECT_NEAR(m.u, combined(m.budget), 1e-12) << name;
}

void expect_right(const AnalysisOutcome& outcome) {
    const double push = 1.8 * 0.5 / 15.0;
    expect_near(outcome, "speed_a_before", 0.5);
    expect_near(outcome, "speed_b_before", 0.0);
    expect_near(outcome, "speed_a_after", 0.5 - push / 0.2);
    expect_near(outcome, "speed_b_after", push / 0.1);
    expect_near(outcome, "momentum_before", 0.1);
    expect_near(outcome, "momentum_balance", 0.0);
    expect_near(outcome, "momentum_balance_across", 0.0);
    expect_near(outcome, "energy_before", 0.025);
    expect_near(outcome, "restitution", 0.8);
    expect_near(outcome, "impact_time", kImpact);
}

TEST(Collision, FindsTheImpactAndItsNumbers) {
    const auto outcome = analysed(head_on());
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_right(*outcome);
    EXPECT_LT(named(*outcome, "impact_time").u, 1e-3);
    EXPECT_EQ(outcome->facts.at("frames_before"), 49.0);
    EXPECT_EQ(outcome->facts.at("frames_after"), 46.0);
    EXPECT_EQ(outcome->fits.size(), 2U);
    EXPECT_EQ(outcome->plots.size(), 5U);
}

TEST(Collision, NoiseThatLastsWidensU) {
    const auto white = analysed(head_on(), 1e-3);
    const auto slow = analysed(head_on(), 1e-3, 0.82);
    ASSERT_TRUE(white && slow);
    expect_right(*slow);
    EXPECT_GT(named(*slow, "speed_a_before").u, 1.7 * named(*white, "speed_a_before").u);
}

TEST(Collision, LeavesOutTheHandAndTheCushion) {
    auto balls = head_on();
    for (std::size_t i = 0; i < 25; ++i)  // a hand brings the first ball there
        balls[0].samples[i].p_lab.x() -= 0.4 * std::pow((25.0 - static_cast<double>(i)) / 30.0, 2);
    for (std::size_t i = 80; i < 95; ++i)  // the second one comes back
        balls[1].samples[i].p_lab.x() -= 1.2 * (static_cast<double>(i) - 80.0) / 30.0;
    const auto outcome = analysed(balls);
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_near(*outcome, "restitution", 0.8);
    expect_near(*outcome, "momentum_balance", 0.0);
}

TEST(Collision, StrayPositionsAreOutliers) {
    auto balls = head_on();
    for (const std::size_t i : {10U, 40U, 52U, 70U})
        balls[0].samples[i].p_lab += Vector3d(0.2, -0.3, 0.1);
    const auto outcome = analysed(balls);
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    expect_right(*outcome);
    EXPECT_EQ(outcome->fits[0].outliers, 4);
}

TEST(Collision, WithoutAMetreGivesWhatNeedsNone) {
    auto balls = head_on();
    for (auto& ball : balls)
        for (auto& s : ball.samples)
            s.p_lab = {600.0 * s.p_lab.x(), 0.0, 0.0};
    for (auto& ball : balls)
        for (std::size_t i = 0; i < ball.samples.size(); ++i)
            ball.samples[i].p_lab += 0.3 * Vector3d(
                                               std::sin(78.233 * static_cast<double>(i * i)),
                                               std::sin(12.9898 * static_cast<double>(i * i)),
                                               0.0
                                           );
    AnalysisConditions pixels;
    pixels.metric = false;
    const auto outcome =
        analyse("collision", balls, {{"mass_a_kg", 0.2}, {"mass_b_kg", 0.1}}, pixels);
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    EXPECT_NEAR(named(*outcome, "restitution").value, 0.8, 0.02);
    EXPECT_FALSE(gives(*outcome, "speed_a_before"));
    EXPECT_FALSE(gives(*outcome, "momentum_balance"));
}

TEST(Collision, DepthScaleCancelsInShares) {
    const auto outcome = analysed(head_on());
    ASSERT_TRUE(outcome);
    for (const auto& line : named(*outcome, "restitution").budget)
        EXPECT_NE(line.source, "depth scale");
    bool found = false;
    for (const auto& line : named(*outcome, "speed_a_before").budget)
        if (line.source == "depth scale") {
            found = true;
            EXPECT_NEAR(line.u, 0.5e-3, 1e-5);
        }
    EXPECT_TRUE(found);
}

TEST(Collision, RefusesWhatShowsNoImpact) {
    const auto apart = [](double v) {
        return moving("ball", 90, [=](double t) { return Vector3d(v * t, 1.5, 0.8); });
    };
    const auto passing = analysed({apart(0.3), apart(-0.2)});
    ASSERT_FALSE(passing);
    EXPECT_NE(to_text(passing.error()).find("no impact"), std::string::npos);
    const auto standing = analysed({apart(0.0), apart(0.0)});
    EXPECT_FALSE(standing);
}

TEST(Collision, RefusesTooFewFramesOnOneSide) {
    const auto outcome = analysed(head_on(0.8, 47));
    ASSERT_FALSE(outcome);
    EXPECT_FALSE(outcome.error().cure.empty());
}

TEST(Collision, RefusesABallThatIsMissingOrNoNumber) {
    auto balls = head_on();
    for (auto& s : balls[1].samples)
        s.status = TrackStatus::lost;
    EXPECT_FALSE(analysed(balls));
    balls = head_on();
    balls[1].samples.clear();
    EXPECT_FALSE(analysed(balls));
    balls = head_on();
    balls[0].samples[20].p_lab.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(analysed(balls));
}

}  // namespace
}  // namespace kinectlab::testing
