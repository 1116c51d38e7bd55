#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/law_paths.hpp"

namespace kinectlab::testing {
namespace {

using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kRelease = 0.6;

/// Held, then thrown with v; without air.
std::function<Vector3d(double)> thrown(const Vector3d& v, double g = 9.81) {
    return [=](double t) {
        const double s = std::max(t - kRelease, 0.0);
        return Vector3d(Vector3d(0.1, 1.5, 0.5) + v * s - Vector3d::UnitZ() * (g * s * s / 2));
    };
}

const AnalysisSettings kVacuum{{"air_density_kg_m3", 0.0}};

void expect_adds_up(const AnalysisOutcome& out) {
    for (const auto& m : out.measurements)
        EXPECT_NEAR(combined(m.budget), m.u, 1e-12 * m.u) << m.name;
}

TEST(Projectile, TellsGAndTheLaunchOfAThrow) {
    for (const Lasting lasting : {Lasting::no, Lasting::yes}) {
        const auto out =
            analysed("projectile", record(1.4, thrown({1.5, 0.0, 3.0}), 3, lasting), kVacuum);
        ASSERT_TRUE(out) << to_text(out.error());
        const Measurement& g = named(*out, "g");
        EXPECT_NEAR(g.value, 9.81, 3.0 * g.u);
        EXPECT_LT(g.u, 0.15);
        const double s = out->facts.at("start_s") - kRelease;
        const Measurement& speed = named(*out, "launch_speed");
        EXPECT_NEAR(speed.value, std::hypot(1.5, 3.0 - 9.81 * s), 3.0 * speed.u);
        const Measurement& elevation = named(*out, "elevation");
        EXPECT_NEAR(elevation.value, std::atan2(3.0 - 9.81 * s, 1.5), 3.0 * elevation.u);
        EXPECT_NEAR(named(*out, "time_to_top").value, 3.0 / 9.81 - s, 0.01);
        expect_adds_up(*out);
        EXPECT_EQ(line(g, "buoyancy"), -1.0) << "a vacuum has none";
        EXPECT_NEAR(line(g, "depth scale"), 1e-3 * g.value, 1e-9);
        EXPECT_NEAR(line(g, "clock"), 2.0 * 2e-5 * g.value, 1e-9);
    }
}

/// A machine that was busy has lost the first pictures.
TEST(Projectile, TheLaunchIsAtTheReleaseThoughItsPicturesAreMissing) {
    auto trajectory = record(1.4, thrown({1.5, 0.0, 3.0}), 3);
    const TimeNs released = trajectory.samples.front().t + from_seconds(kRelease);
    std::erase_if(trajectory.samples, [&](const MotionSample& sample) {
        return sample.t < released + from_seconds(0.12);
    });
    AnalysisConditions conditions;
    const auto later = analyse("projectile", {&trajectory, 1}, kVacuum, conditions);
    conditions.released = released;
    const auto out = analyse("projectile", {&trajectory, 1}, kVacuum, conditions);
    ASSERT_TRUE(out && later);
    const Measurement& speed = named(*out, "launch_speed");
    EXPECT_NEAR(speed.value, std::hypot(1.5, 3.0), 3.0 * speed.u);
    EXPECT_LT(named(*later, "launch_speed").value, speed.value - 0.8);
    const Measurement& elevation = named(*out, "elevation");
    EXPECT_NEAR(elevation.value, std::atan2(3.0, 1.5), 3.0 * elevation.u);
    EXPECT_NEAR(line(elevation, "moment of release"), 1.5 * 9.81 / 11.25 * 0.002, 2e-4);
    EXPECT_NEAR(named(*out, "time_to_top").value, 3.0 / 9.81, 0.01);
    expect_adds_up(*out);
}

TEST(Projectile, ReleasedFromRestHasNoLaunch) {
    const auto out = analysed("projectile", record(1.05, thrown(Vector3d::Zero())), kVacuum);
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_NEAR(named(*out, "g").value, 9.81, 3.0 * named(*out, "g").u);
    EXPECT_EQ(find(*out, "elevation"), nullptr);
    EXPECT_THAT(out->notes, Contains(HasSubstr("straight")));
}

TEST(Projectile, UnknownAirIsInTheBudget) {
    const auto out = analysed("projectile", record(1.4, thrown({1.5, 0.0, 3.0})));
    ASSERT_TRUE(out) << to_text(out.error());
    const Measurement& g = named(*out, "g");
    EXPECT_GT(line(g, "drag"), 0.0);
    EXPECT_GT(line(g, "buoyancy"), 0.01);
    expect_adds_up(*out);
}

TEST(Projectile, TheFitReachesNoFartherThanTheFlight) {
    const auto out = analysed("projectile", record(1.4, thrown({1.5, 0.0, 3.0})), kVacuum);
    ASSERT_TRUE(out) << to_text(out.error());
    const ObjectFit& fit = out->fits.front();
    EXPECT_FALSE(fit.fit_lab.front().allFinite());
    EXPECT_TRUE(fit.fit_lab.back().allFinite());
    EXPECT_EQ(out->plots.size(), 4u);
    EXPECT_THAT(out->warnings, Contains(HasSubstr("free flight")));
}

TEST(Projectile, InPixelsItTellsAnglesAndTimesOnly) {
    const auto metres = thrown({1.5, 0.0, 3.0});
    const auto pixels = [&](double t) {
        const Vector3d p = metres(t);
        return Vector3d(400.0 * p.x(), 0.0, 400.0 * p.z());
    };
    AnalysisConditions conditions;
    conditions.metric = false;
    const auto out =
        analysed("projectile", record(1.4, pixels, 1, Lasting::no, 400.0), kVacuum, conditions);
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_EQ(find(*out, "g"), nullptr);
    EXPECT_EQ(find(*out, "launch_speed"), nullptr);
    EXPECT_NE(find(*out, "elevation"), nullptr);
    EXPECT_NE(find(*out, "time_to_top"), nullptr);
    EXPECT_THAT(out->notes, Contains(HasSubstr("pixels")));
}

TEST(Projectile, RefusesWhatDoesNotFly) {
    const auto message = [](const Trajectory& path) {
        const auto out = analysed("projectile", path, kVacuum);
        return out ? std::string("a number came out") : out.error().message;
    };
    EXPECT_THAT(
        message(record(3.0, [](double) { return Vector3d(0, 1, 0); })), HasSubstr("no free flight")
    );
    EXPECT_THAT(
        message(record(3.0, [](double t) { return Vector3d(0.2 * t, 1, 0); })),
        HasSubstr("no free flight")
    );
    EXPECT_THAT(
        message(record(3.0, [](double t) { return Vector3d(0.3 * std::sin(3 * t), 1, 0); })),
        HasSubstr("no free flight")
    );
    EXPECT_THAT(message(record(0.2, thrown({1, 0, 3}))), HasSubstr("6 of 6 frames"));
    Trajectory broken = record(1.4, thrown({1, 0, 3}));
    broken.samples[5].p_lab.x() = std::nan("");
    EXPECT_THAT(message(broken), HasSubstr("sample 5"));
}

TEST(Projectile, WarnsOfAScaleThatIsNotTheEarths) {
    const auto out = analysed("projectile", record(1.4, thrown({1.5, 0.0, 3.0}, 8.5)), kVacuum);
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_THAT(out->warnings, Contains(HasSubstr("not found on the Earth")));
}

}  // namespace
}  // namespace kinectlab::testing
