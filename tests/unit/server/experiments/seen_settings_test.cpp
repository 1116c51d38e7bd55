#include "server/experiments/seen_settings.hpp"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiments/share_dir.hpp"

namespace kinectlab::experiments {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kAny = std::numbers::pi * std::numbers::pi / 3.0;

/// A plane that leans about the lab's y, seen in some frames with a turn of so much about itself.
Trajectory plane(const std::string& name, std::vector<double> tilts_deg, double u_deg) {
    Trajectory trajectory{name, {}};
    for (const double tilt : tilts_deg) {
        MotionSample sample;
        sample.t = static_cast<TimeNs>(trajectory.samples.size() + 1) * 33'000'000;
        sample.status = TrackStatus::tracked;
        sample.has_orientation = true;
        sample.q_lab_obj = Eigen::AngleAxisd(tilt * kDegree, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
        const Eigen::Vector3d normal = sample.q_lab_obj * Eigen::Vector3d::UnitZ();
        const Eigen::Vector3d across = normal.cross(Eigen::Vector3d::UnitY());
        sample.covariance.bottomRightCorner<3, 3>() =
            kAny * normal * normal.transpose() + 0.1 * across * across.transpose() +
            std::pow(u_deg * kDegree, 2) * Eigen::Vector3d::UnitY() *
                Eigen::Vector3d::UnitY().transpose();
        trajectory.samples.push_back(sample);
    }
    return trajectory;
}

TEST(SeenSettings, APlanesTiltIsAsSureAsThePlaneAndTheLevel) {
    const std::vector all{plane("plank", {12.0, 12.0, 12.0}, 0.3)};
    const auto tilt = tilt_of(all, "plank", 0.4 * kDegree);
    ASSERT_TRUE(tilt);
    EXPECT_NEAR(tilt->deg, 12.0, 1e-9);
    // Neither the turn about its own normal nor the one that leans it sideways counts.
    EXPECT_NEAR(tilt->u_deg, 0.5, 1e-9);
}

TEST(SeenSettings, WhatScattersMoreThanItClaimsIsLessSure) {
    const std::vector all{plane("plank", {11.0, 13.0, 11.0, 13.0}, 0.01)};
    const auto tilt = tilt_of(all, "plank", 0.0);
    ASSERT_TRUE(tilt);
    EXPECT_NEAR(tilt->deg, 12.0, 1e-6);
    EXPECT_NEAR(tilt->u_deg, 1.0, 1e-3);
}

TEST(SeenSettings, ALevelPlaneHasAnUncertaintyToo) {
    const auto tilt = tilt_of({plane("table", {0.0}, 0.3)}, "table", 0.0);
    ASSERT_TRUE(tilt);
    EXPECT_NEAR(tilt->deg, 0.0, 1e-9);
    EXPECT_GT(tilt->u_deg, 0.29);
}

struct InclineRun {
    Definition definition = load_definition(share_dir() / "experiments", "incline").value();
    Values values = validate(definition, {}).value();
    std::vector<Trajectory> trajectories;
    std::map<std::string, std::optional<double>> overrides;

    [[nodiscard]] Result<SeenSettings> settings() const {
        AnalysisConditions conditions;
        conditions.tilt_u_rad = 0.001;
        return settings_of({definition, values, trajectories, conditions, overrides});
    }
};

TEST(SeenSettings, TheInclineHasItsAngleFromThePlank) {
    InclineRun run;
    run.trajectories = {{"ball", {}}, plane("plank", {7.5, 7.5}, 0.02)};
    const auto settings = run.settings();
    ASSERT_TRUE(settings) << to_text(settings.error());
    EXPECT_NEAR(settings->values.at("incline_deg"), 7.5, 1e-9);
    EXPECT_NEAR(settings->values.at("incline_u_deg"), std::hypot(0.02, 0.001 / kDegree), 1e-9);
    EXPECT_THAT(settings->warnings, ElementsAre());
}

TEST(SeenSettings, WithoutThePlankItSaysSoAndGoesOn) {
    InclineRun run;
    Trajectory lost = plane("plank", {7.5, 7.5}, 0.02);
    for (auto& sample : lost.samples)
        sample.status = TrackStatus::lost;
    for (const auto& trajectories :
         {std::vector<Trajectory>{{"ball", {}}}, std::vector<Trajectory>{{"ball", {}}, lost}}) {
        run.trajectories = trajectories;
        const auto settings = run.settings();
        ASSERT_TRUE(settings) << to_text(settings.error());
        EXPECT_EQ(settings->values.count("incline_deg"), 0u);
        EXPECT_EQ(settings->values.count("incline_u_deg"), 0u);
        EXPECT_THAT(settings->warnings, ElementsAre(HasSubstr("The plank was not seen")));
    }
    run.overrides = {{"incline_deg", 9.0}, {"incline_u_deg", 0.2}};
    const auto told = run.settings();
    ASSERT_TRUE(told);
    EXPECT_EQ(told->values.at("incline_deg"), 9.0);
    EXPECT_THAT(told->warnings, ElementsAre()) << "somebody measured it otherwise";
}

TEST(SeenSettings, WhatTheAnalysisCannotDoWithoutIsAnError) {
    InclineRun run;
    run.definition.analysis.method = "collision";
    run.definition.analysis.settings["mass_a_kg"].tilt_of = "plank";
    EXPECT_FALSE(run.settings());
}

}  // namespace
}  // namespace kinectlab::experiments
