#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/rig/run_analysis.hpp"
#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::rig {
namespace {

/// A small swing of 1 m, seen for 20 s with 0.1 mm of noise that goes up and down.
Trajectory swing() {
    Trajectory bob{"bob", {}};
    for (int i = 0; i < 600; ++i) {
        const double t = i / 30.0;
        const double angle = 0.05 * std::cos(std::sqrt(9.81) * t);
        MotionSample s;
        s.t = test::kNoon + from_seconds(t);
        s.status = TrackStatus::tracked;
        s.p_lab = {std::sin(angle), 1e-4 * (i % 2 == 0 ? 1 : -1), 2.0 - std::cos(angle)};
        s.covariance.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * 1e-8;
        bob.samples.push_back(s);
    }
    return bob;
}

Reanalysis wish(std::map<std::string, std::optional<double>> settings = {}) {
    return {
        experiments::read_definition(nlohmann::json::parse(test::pendulum_json())).value(),
        std::move(settings),
        "Ada",
        test::kNoon};
}

lab::Run finished_run() {
    lab::Run run;
    run.id = 7;
    run.rig = "rig-1";
    run.experiment = "pendulum";
    run.parameters = {
        {"length_m", 1.0}, {"length_u_m", 0.001}, {"bob_radius_m", 0.0}, {"latitude_deg", 45.0}};
    run.definition_json = test::pendulum_json();
    run.created = test::kNoon;
    return run;
}

double g_of(const RunAnalysis& analysis) {
    return nlohmann::json::parse(analysis.result_json)["results"][0]["value"].get<double>();
}

TEST(Reanalysis, TakesOtherSettingsAndSaysSo) {
    const auto first = analyse_again(finished_run(), {swing()}, "{}", wish());
    ASSERT_TRUE(first) << to_text(first.error());
    const auto other =
        analyse_again(finished_run(), {swing()}, first->result_json, wish({{"length_m", 1.01}}));
    ASSERT_TRUE(other) << to_text(other.error());
    EXPECT_NEAR(g_of(*other) / g_of(*first), 1.01, 1e-4);
    const auto result = nlohmann::json::parse(other->result_json);
    EXPECT_EQ(result["analysis"]["settings"]["length_m"], 1.01);
    EXPECT_EQ(result["provenance"]["analysed_by"], "Ada");
    EXPECT_EQ(result["provenance"]["from"], "stored poses");
    EXPECT_FALSE(nlohmann::json::parse(other->plots_json).empty());
}

TEST(Reanalysis, RefusesSettingsThatTheAnalysisDoesNotHave) {
    const auto unknown = analyse_again(finished_run(), {swing()}, "{}", wish({{"lenght_m", 1.0}}));
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().field, "lenght_m");
    const auto range = analyse_again(finished_run(), {swing()}, "{}", wish({{"length_m", -1.0}}));
    ASSERT_FALSE(range);
    EXPECT_EQ(range.error().field, "length_m");
    EXPECT_FALSE(analyse_again(finished_run(), {}, "{}", wish()));
}

TEST(Reanalysis, MarksARunThatMissesItsChecks) {
    Trajectory brief = swing();
    brief.samples.resize(250);  // four periods
    const auto analysis = analyse_again(finished_run(), {brief}, "{}", wish());
    ASSERT_TRUE(analysis) << to_text(analysis.error());
    const auto result = nlohmann::json::parse(analysis->result_json);
    EXPECT_EQ(result["accepted"], false);
    bool missed = false;
    for (const auto& check : result["acceptance"])
        missed = missed || (check["fact"] == "periods" && check["ok"] == false &&
                            !check["reason"].get<std::string>().empty());
    EXPECT_TRUE(missed);
}

}  // namespace
}  // namespace kinectlab::rig
