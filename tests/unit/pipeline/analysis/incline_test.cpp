#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/analysis/incline_rolling.hpp"
#include "tests/unit/pipeline/analysis/law_paths.hpp"

namespace kinectlab::testing {
namespace {

using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kG = 9.80665;

/// At rest, then down a slope with an acceleration, and stopped after a metre and a half.
std::function<Vector3d(double)> rolls(double angle, double a) {
    return [=](double t) {
        const double s = std::max(t - 1.0, 0.0);
        const Vector3d down(std::cos(angle), 0.0, -std::sin(angle));
        return Vector3d(Vector3d(-0.7, 1.5, 0.4) + down * std::min(1.5, a * s * s / 2));
    };
}

AnalysisConditions levelled() {
    AnalysisConditions conditions;
    conditions.tilt_u_rad = 1e-3;
    return conditions;
}

TEST(Incline, TellsAccelerationAngleAndG) {
    const double angle = 10.0 * kDegree;
    const double a = kG * std::sin(angle) / 1.4;
    for (const Lasting lasting : {Lasting::no, Lasting::yes}) {
        const auto out = analysed(
            "incline",
            record(3.5, rolls(angle, a), 2, lasting),
            {{"rolling_resistance", 0.0}},
            levelled()
        );
        ASSERT_TRUE(out) << to_text(out.error());
        for (const auto& [name, truth] :
             {std::pair{"acceleration", a}, {"angle", angle}, {"g", kG}}) {
            const Measurement& m = named(*out, name);
            EXPECT_NEAR(m.value, truth, 3.0 * m.u) << name;
            EXPECT_NEAR(combined(m.budget), m.u, 1e-12) << name;
        }
        EXPECT_GT(out->facts.at("rolling_probability"), 0.5);
        EXPECT_GT(line(named(*out, "g"), "camera tilt"), 0.0);
        EXPECT_NEAR(out->facts.at("start_s"), 1.0, 0.25);
        EXPECT_EQ(out->plots.size(), 4u);
    }
}

TEST(Incline, ToldTheAngleTheTiltOfTheCameraDoesNotCount) {
    const double angle = 10.0 * kDegree;
    const AnalysisSettings settings{{"incline_deg", 10.0}, {"incline_u_deg", 0.1}};
    const auto out =
        analysed("incline", record(3.5, rolls(angle, kG * std::sin(angle) / 1.4)), settings);
    ASSERT_TRUE(out) << to_text(out.error());
    const Measurement& g = named(*out, "g");
    EXPECT_EQ(line(g, "camera tilt"), -1.0);
    EXPECT_NEAR(line(g, "incline"), g.value / std::tan(angle) * 0.1 * kDegree, 1e-6);
    EXPECT_GT(line(g, "rolling resistance"), 0.0) << "it was not given";
    EXPECT_NEAR(out->facts.at("path_angle_deg"), 10.0, 0.2);
    EXPECT_NEAR(
        out->facts.at("path_minus_plank_deg"), out->facts.at("path_angle_deg") - 10.0, 1e-9
    );
    EXPECT_THAT(out->notes, Contains(HasSubstr("the plank's, 10.00°")));
}

TEST(Incline, ToldNoAngleItSaysThatItIsThePaths) {
    const double angle = 10.0 * kDegree;
    const auto out = analysed("incline", record(3.5, rolls(angle, kG * std::sin(angle) / 1.4)), {});
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_THAT(out->notes, Contains(HasSubstr("that of the ball's path")));
    EXPECT_EQ(out->facts.count("path_minus_plank_deg"), 0u);
    EXPECT_NEAR(out->facts.at("path_angle_deg"), 10.0, 0.2);
}

TEST(Incline, KnowsASlidingBall) {
    const double angle = 25.0 * kDegree;
    const double a = kG * (std::sin(angle) - 0.08 * std::cos(angle));
    const auto out =
        analysed("incline", record(3.0, rolls(angle, a)), {{"latitude_deg", 45.5}}, levelled());
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_LT(out->facts.at("rolling_probability"), 0.01);
    EXPECT_EQ(find(*out, "g"), nullptr);
    const Measurement& friction = named(*out, "friction");
    EXPECT_NEAR(friction.value, 0.08, 3.0 * friction.u);
}

TEST(Incline, WarnsOfAnAngleThatIsNotThePaths) {
    const double angle = 10.0 * kDegree;
    const AnalysisSettings settings{{"incline_deg", 20.0}, {"incline_u_deg", 0.5}};
    const auto out =
        analysed("incline", record(3.5, rolls(angle, kG * std::sin(angle) / 1.4)), settings);
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_THAT(out->warnings, Contains(HasSubstr("is the angle right")));
}

TEST(Incline, InPixelsItTellsTheAngleOnly) {
    const auto metres = rolls(0.2, 1.4);
    AnalysisConditions conditions;
    conditions.metric = false;
    const auto out = analysed(
        "incline",
        record(
            3.0, [&](double t) { return Vector3d(300.0 * metres(t)); }, 1, Lasting::no, 300.0
        ),
        {},
        conditions
    );
    ASSERT_TRUE(out) << to_text(out.error());
    ASSERT_EQ(out->measurements.size(), 1u);
    EXPECT_NEAR(named(*out, "angle").value, 0.2, 3.0 * named(*out, "angle").u);
}

TEST(Incline, RefusesWhatDoesNotRollDown) {
    const auto message = [](const std::function<Vector3d(double)>& p) {
        const auto out = analysed("incline", record(3.0, p));
        return out ? std::string("a number came out") : out.error().message;
    };
    EXPECT_THAT(message([](double) { return Vector3d(0, 1, 0); }), HasSubstr("nothing moves"));
    EXPECT_THAT(
        message([](double t) { return Vector3d(0.3 * t, 1, -0.1 * t); }),
        HasSubstr("without speeding up")
    );
    EXPECT_THAT(
        message([](double t) { return Vector3d(0, 1, -4.9 * std::pow(std::max(t - 2.4, 0.0), 2)); }
        ),
        HasSubstr("falls straight down")
    );
    const auto groove =
        analysed("incline", record(3.0, rolls(0.2, 1.4)), {{"groove_width_m", 0.1}});
    ASSERT_FALSE(groove);
    EXPECT_EQ(groove.error().field, "groove_width_m");
}

TEST(Incline, RollsOnAGroovesEdges) {
    EXPECT_DOUBLE_EQ(rolling_inertia(0.02, 0.0), 1.4);
    EXPECT_NEAR(rolling_inertia(1.0, std::sqrt(2.0)), 1.8, 1e-12);
}

TEST(Incline, NormalGravityOfWgs84) {
    EXPECT_NEAR(local_gravity(0.0).g, 9.7803253359, 1e-10);
    EXPECT_NEAR(local_gravity(90.0).g, 9.8321849378, 1e-9);
    EXPECT_NEAR(local_gravity(45.0).g, 9.80620, 1e-5);
}

}  // namespace
}  // namespace kinectlab::testing
