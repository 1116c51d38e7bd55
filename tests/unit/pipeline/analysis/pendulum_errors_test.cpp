#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

// Bad input: an error that says what is wrong, never a number. Poor input: a number and a warning.

namespace kinectlab::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Error error_of(const Trajectory& path, const PendulumSettings& settings = usual_settings()) {
    const auto result = analyse_pendulum(path, settings);
    if (!result) return result.error();
    ADD_FAILURE() << "a number came out: g = " << result->measurements.front().value;
    return {};
}

std::vector<std::string> warnings_of(
    const Trajectory& path, const PendulumSettings& settings = usual_settings()
) {
    const auto result = analyse_pendulum(path, settings);
    if (result) return result->warnings;
    ADD_FAILURE() << to_text(result.error());
    return {};
}

TEST(PendulumErrors, NothingAtAll) {
    EXPECT_THAT(error_of({"bob", {}}).message, HasSubstr("0 of 0 frames"));
}

TEST(PendulumErrors, NearlyAllLost) {
    Trajectory path = generate({});
    for (std::size_t i = 0; i < path.samples.size(); ++i)
        if (i % 60 != 0) path.samples[i].status = TrackStatus::lost;
    EXPECT_THAT(error_of(path).message, HasSubstr("seen in 15 of 900 frames"));
}

TEST(PendulumErrors, InterpolatedSamplesDoNotCount) {
    Trajectory path = generate({});
    for (auto& m : path.samples)
        m.status = TrackStatus::interpolated;
    EXPECT_THAT(error_of(path).message, HasSubstr("seen in 0 of 900 frames"));
}

// Seen on one side alone, it looks like a smaller swing of half the period: four times g.
TEST(PendulumErrors, SeenOnOneSideAlone) {
    const Swing swing{.amplitude_deg = 1.0};
    Trajectory path = with_noise(generate(swing), 3);
    for (auto& m : path.samples)
        if (m.p_lab.x() < swing.pivot.x() + 0.003) m.status = TrackStatus::lost;
    EXPECT_THAT(error_of(path).message, HasSubstr("out of sight"));
}

TEST(PendulumErrors, BroughtThereByALargerMotionThanItsSwing) {
    Trajectory path = generate({.amplitude_deg = 2.0, .seconds = 8.0});
    const Eigen::Vector3d aside(0.09, 0.0, 0.0);
    Trajectory before = path;
    before.samples.assign(150, path.samples.front());
    for (std::size_t i = 0; i < before.samples.size(); ++i) {
        before.samples[i].t -= static_cast<TimeNs>(before.samples.size() - i) * kNsPerSecond / 30;
        if (i < 100) before.samples[i].p_lab += aside;
    }
    before.samples.insert(before.samples.end(), path.samples.begin(), path.samples.end());
    const auto result = analyse_pendulum(with_noise(before, 3), usual_settings());
    ASSERT_TRUE(result) << to_text(result.error());
    EXPECT_NEAR(result->measurements.front().value, 9.81, 0.03);
}

TEST(PendulumErrors, FewerThanThreePeriods) {
    for (const double seconds : {1.5, 3.0, 5.5}) {
        const Error error = error_of(with_noise(generate({.seconds = seconds}), 3));
        EXPECT_EQ(error.code, ErrorCode::bad_data);
        EXPECT_THAT(error.message, HasSubstr("periods"));
        EXPECT_THAT(error.cure, HasSubstr("three periods"));
    }
}

TEST(PendulumErrors, FewerThanThreePeriodsAfterTheRelease) {
    EXPECT_THAT(
        error_of(with_noise(generate({.seconds = 4.5, .rest = 4.0, .held = 2.0}), 3)).message,
        HasSubstr("swing")
    );
}

// Four to five seconds of a pendulum of two, after a rest: too short, and its length is right.
TEST(PendulumErrors, TooShortASwingIsNotBlamedOnTheLength) {
    for (const double seconds : {3.5, 4.0, 4.5, 5.0, 5.5}) {
        const Swing swing{.amplitude_deg = 10.0, .seconds = seconds, .rest = 3.0, .held = 1.0};
        const Error error = error_of(with_noise(generate(swing), 3));
        EXPECT_THAT(error.message, Not(HasSubstr("given length"))) << seconds;
        EXPECT_THAT(error.message, HasSubstr("period")) << seconds;
        EXPECT_THAT(error.cure, HasSubstr("three periods")) << seconds;
    }
}

TEST(PendulumErrors, NoMotion) {
    EXPECT_THAT(error_of(generate({.amplitude_deg = 0})).message, HasSubstr("does not swing"));
    for (unsigned seed = 1; seed <= 5; ++seed)
        EXPECT_THAT(
            error_of(with_noise(generate({.amplitude_deg = 0}), seed)).message,
            HasSubstr("does not swing")
        );
}

TEST(PendulumErrors, SomethingElseThatMoves) {
    std::mt19937_64 random(4);
    std::normal_distribution<double> push(0.0, 0.02);
    Trajectory path = generate({.amplitude_deg = 0});
    Eigen::Vector3d walk = Eigen::Vector3d::Zero();
    for (auto& m : path.samples) {
        walk += Eigen::Vector3d(push(random), push(random), push(random));
        m.p_lab += walk;
    }
    EXPECT_EQ(error_of(path).code, ErrorCode::bad_data);
}

TEST(PendulumErrors, AmplitudeBeyond80Degrees) {
    for (const double degrees : {82.0, 85.0, 120.0, 160.0})
        EXPECT_THAT(error_of(generate({.amplitude_deg = degrees})).message, HasSubstr("80°"))
            << degrees;
}

TEST(PendulumErrors, NotANumber) {
    Trajectory path = generate({});
    path.samples[7].p_lab.y() = std::nan("");
    EXPECT_THAT(error_of(path).message, HasSubstr("sample 7"));
    path = generate({});
    path.samples[8].covariance(1, 1) = std::numeric_limits<double>::infinity();
    EXPECT_THAT(error_of(path).message, HasSubstr("sample 8"));
}

TEST(PendulumErrors, TimesThatDoNotIncrease) {
    Trajectory path = generate({});
    path.samples[9].t = path.samples[8].t;
    EXPECT_THAT(error_of(path).message, HasSubstr("sample 9"));
}

TEST(PendulumErrors, SettingsOutOfRangeAreNamed) {
    const auto field_of = [](auto change) {
        PendulumSettings settings = usual_settings();
        change(settings);
        const Error error = error_of(generate({.seconds = 7.0}), settings);
        EXPECT_EQ(error.code, ErrorCode::invalid_argument);
        EXPECT_FALSE(error.cure.empty());
        return error.field;
    };
    EXPECT_EQ(field_of([](auto& s) { s.length_m = 0.0; }), "length_m");
    EXPECT_EQ(field_of([](auto& s) { s.length_m = std::nan(""); }), "length_m");
    EXPECT_EQ(field_of([](auto& s) { s.length_u_m = -1e-3; }), "length_u_m");
    EXPECT_EQ(field_of([](auto& s) { s.body.bob_radius_m = 1.5; }), "bob_radius_m");
    EXPECT_EQ(field_of([](auto& s) { s.latitude_deg = 91.0; }), "latitude_deg");
    EXPECT_EQ(field_of([](auto& s) { s.depth_scale_u = -1.0; }), "depth_scale_u");
    EXPECT_EQ(field_of([](auto& s) { s.clock_u = std::nan(""); }), "clock_u");
}

TEST(PendulumWarnings, NoneForAGoodRun) {
    EXPECT_THAT(warnings_of(with_noise(generate({}), 1)), IsEmpty());
}

TEST(PendulumWarnings, FewPeriods) {
    const Trajectory path = with_noise(generate({.seconds = 9.0}), 1);
    PendulumSettings precise = usual_settings();
    precise.length_u_m = precise.depth_scale_u = precise.clock_u = 1e-6;
    EXPECT_THAT(warnings_of(path, precise), Contains(HasSubstr("periods were recorded")));
    PendulumSettings rough = usual_settings();
    rough.length_u_m = 0.02;
    EXPECT_THAT(warnings_of(path, rough), Not(Contains(HasSubstr("periods were recorded"))))
        << "more periods would not help: the length decides";
}

TEST(PendulumWarnings, SmallSwing) {
    EXPECT_THAT(
        warnings_of(with_noise(generate({.amplitude_deg = 0.5}), 1)),
        Contains(HasSubstr("small against"))
    );
}

TEST(PendulumWarnings, WrongLength) {
    PendulumSettings settings = usual_settings();
    settings.length_m = 1.1;
    EXPECT_THAT(
        warnings_of(with_noise(generate({.amplitude_deg = 20}), 1), settings),
        Contains(HasSubstr("but the length given is 1.10 m"))
    );
}

TEST(PendulumWarnings, GravityOfAnotherPlanet) {
    const Trajectory path = with_noise(generate({.g = 1.62}), 1);
    EXPECT_THAT(warnings_of(path), Contains(HasSubstr("not found on the Earth")));
    PendulumSettings simulated = usual_settings();
    simulated.on_earth = false;
    EXPECT_THAT(warnings_of(path, simulated), Not(Contains(HasSubstr("not found on the Earth"))))
        << "a simulation was asked for it";
}

TEST(PendulumWarnings, LostFrames) {
    Trajectory path = with_noise(generate({}), 1);
    for (std::size_t i = 0; i < path.samples.size(); ++i)
        if (i % 2 == 1) path.samples[i].status = TrackStatus::lost;
    EXPECT_THAT(warnings_of(path), Contains(HasSubstr("not seen in 50 %")));
}

TEST(PendulumWarnings, MisfitOfTheModel) {
    Trajectory path = with_noise(generate({}), 1);
    for (auto& m : path.samples)
        m.covariance *= 0.1;
    EXPECT_THAT(warnings_of(path), Contains(HasSubstr("reduced chi²")));
}

TEST(PendulumWarnings, TiltedCamera) {
    Trajectory path = with_noise(generate({}), 1, {1e-4, 1e-4});
    const Eigen::AngleAxisd tilt(0.06, Eigen::Vector3d::UnitY());
    for (auto& m : path.samples)
        m.p_lab = tilt * m.p_lab;
    EXPECT_THAT(warnings_of(path), Contains(HasSubstr("plumb line")));
}

}  // namespace
}  // namespace kinectlab::testing
