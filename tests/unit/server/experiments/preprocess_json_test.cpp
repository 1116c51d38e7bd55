#include "server/experiments/preprocess_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/experiments/objects_json.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

using testing::HasSubstr;

Result<PreprocessSettings> read(const std::string& text) {
    return parse_json(text, "objects.json").and_then([](const nlohmann::json& json) {
        return read_preprocess(json, "preprocess");
    });
}

TEST(Preprocess, NothingSaidIsTheDefault) {
    const auto settings = read("{}");
    ASSERT_TRUE(settings);
    EXPECT_FALSE(settings->outliers);
    EXPECT_FALSE(settings->smoothing);
    EXPECT_EQ(settings->reference.method, ReferenceMethod::scene);
    EXPECT_EQ(settings->change.method, ChangeMethod::image_grid);
    EXPECT_EQ(settings->change.threshold_steps, 4.0);
    EXPECT_EQ(settings->min_segment_points, 60);
}

TEST(Preprocess, EveryStageHasItsMethods) {
    const auto settings = read(R"({
        "outliers": {"method": "statistical", "neighbours": 50, "sigma_factor": 2},
        "smoothing": {"method": "moving_least_squares", "order": 1, "radius_m": 0.03},
        "depth_cut": {"method": "fixed", "farthest_m": 2.5},
        "reference": {"method": "rolling", "seconds": 5},
        "change": {"method": "octree", "voxel_m": 0.04, "least_points": 3, "threshold_steps": 5},
        "segments": {"min_points": 100}})");
    ASSERT_TRUE(settings) << to_text(settings.error());
    EXPECT_EQ(settings->outliers->neighbours, 50);
    EXPECT_EQ(settings->outliers->sigma_factor, 2.0);
    EXPECT_EQ(settings->smoothing->basis, Basis::linear);
    EXPECT_EQ(settings->smoothing->radius_m, 0.03);
    EXPECT_EQ(settings->smoothing->epsilon_m, 0.03) << "the radius, if not said";
    EXPECT_EQ(settings->depth_cut.method, CutMethod::fixed);
    EXPECT_EQ(settings->depth_cut.farthest_m, 2.5);
    EXPECT_EQ(settings->reference.method, ReferenceMethod::rolling);
    EXPECT_EQ(settings->reference.seconds, 5.0);
    EXPECT_EQ(settings->change.method, ChangeMethod::octree);
    EXPECT_EQ(settings->change.voxel_m, 0.04);
    EXPECT_EQ(settings->change.least_points, 3);
    EXPECT_EQ(settings->change.threshold_steps, 5.0);
    EXPECT_EQ(settings->min_segment_points, 100);
    const auto again = read(to_json(*settings).dump());
    ASSERT_TRUE(again) << to_text(again.error());
    EXPECT_EQ(to_json(*again), to_json(*settings));
}

TEST(Preprocess, StandsBesideTheObjects) {
    const auto plan = parse_json(
                          R"({"objects": [{"name": "a", "method": "change", "memory_s": 5}],
                              "preprocess": {"reference": {"method": "median"}}})",
                          "objects.json"
    )
                          .and_then(read_tracking_plan);
    ASSERT_TRUE(plan) << to_text(plan.error());
    EXPECT_EQ(plan->preprocess.reference.method, ReferenceMethod::median);
    EXPECT_EQ(std::get<ChangeTrackSettings>(plan->objects[0].settings).memory_s, 5.0);
}

struct Wrong {
    const char* text;
    const char* field;
    const char* cure;
};

class WrongPreprocess : public testing::TestWithParam<Wrong> {};

TEST_P(WrongPreprocess, NamesTheFieldAndTheCure) {
    const auto settings = read(GetParam().text);
    ASSERT_FALSE(settings) << GetParam().text;
    EXPECT_EQ(settings.error().field, GetParam().field);
    EXPECT_THAT(settings.error().cure, HasSubstr(GetParam().cure));
}

INSTANTIATE_TEST_SUITE_P(
    All,
    WrongPreprocess,
    testing::Values(
        Wrong{"[]", "preprocess", "outliers"},
        Wrong{R"({"outlier": {}})", "preprocess.outlier", "did you mean outliers?"},
        Wrong{R"({"change": 3})", "preprocess.change", "method"},
        Wrong{
            R"({"change": {"method": "octre"}})",
            "preprocess.change.method",
            "did you mean octree? Valid: image_grid, octree"},
        Wrong{R"({"change": {"method": 3}})", "preprocess.change.method", "text"},
        Wrong{
            R"({"change": {"threshold": 3}})",
            "preprocess.change.threshold",
            "did you mean threshold_steps?"},
        Wrong{
            R"({"change": {"voxel_m": 0.1}})",
            "preprocess.change.voxel_m",
            "valid: method, threshold_steps"},
        Wrong{
            R"({"change": {"threshold_steps": -1}})",
            "preprocess.change.threshold_steps",
            "above 0"},
        Wrong{
            R"({"smoothing": {"method": "mls"}})",
            "preprocess.smoothing.method",
            "did you mean moving_least_squares?"},
        Wrong{
            R"({"smoothing": {"method": "gauss"}})",
            "preprocess.smoothing.method",
            "valid: moving_least_squares, none"},
        Wrong{R"({"outliers": {"neighbours": 1.5}})", "preprocess.outliers.neighbours", "whole"},
        Wrong{R"({"outliers": {"neighbours": 1e6}})", "preprocess.outliers.neighbours", "4096"},
        Wrong{R"({"smoothing": {"order": 3}})", "preprocess.smoothing.order", "1 (linear)"},
        Wrong{R"({"smoothing": {"radius_m": "a"}})", "preprocess.smoothing.radius_m", "number"},
        Wrong{
            R"({"reference": {"method": "rolling", "seconds": 0}})",
            "preprocess.reference.seconds",
            "seconds above 0"}
    )
);

TEST(Preprocess, NumbersStandInErrorsAsTheyWereWritten) {
    EXPECT_EQ(read(R"({"outliers": {"neighbours": 0}})").error().message, "is 0");
    EXPECT_EQ(read(R"({"outliers": {"neighbours": 5000}})").error().message, "is 5000");
    EXPECT_EQ(read(R"({"smoothing": {"radius_m": 0.25}})").error().message, "is 0.25");
}

}  // namespace
}  // namespace kinectlab::experiments
