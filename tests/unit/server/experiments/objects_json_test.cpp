#include "server/experiments/objects_json.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/experiments/model_files.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

using testing::HasSubstr;

Error error_of(const std::string& text) {
    const auto plan = parse_json(text, "objects.json").and_then(read_tracking_plan);
    EXPECT_FALSE(plan) << text;
    return plan ? Error{} : plan.error();
}

TEST(Objects, ReadsSpheresAndWhateverMoved) {
    const auto plan = parse_json(
                          R"({"objects":[
        {"name":"bob","method":"sphere","radius_m":0.05},
        {"name":"ball 2","method":"sphere","min_radius_m":0.02},
        {"name":"boxes","method":"change"}]})",
                          "objects.json"
    )
                          .and_then(read_tracking_plan);
    ASSERT_TRUE(plan) << to_text(plan.error());
    const auto& objects = plan->objects;
    ASSERT_EQ(objects.size(), 3u);
    EXPECT_EQ(std::get<SphereSettings>(objects[0].settings).radius_m, 0.05);
    const auto& free = std::get<SphereSettings>(objects[1].settings);
    EXPECT_FALSE(free.radius_m);
    EXPECT_EQ(free.min_radius_m, 0.02);
    EXPECT_EQ(method_of(objects[2]), "change");
}

TEST(Objects, AModelIsLookedForBesideTheFileThatNamesIt) {
    const auto document = nlohmann::json::parse(
        R"({"objects":[{"model":"box.obj"},{"model":"/models/box.obj"},{"name":"bob"}]})"
    );
    const auto here = with_models_beside("mine.json", document);  // as typed in its own folder
    EXPECT_EQ(here["objects"][0]["model"], (std::filesystem::current_path() / "box.obj").string());
    EXPECT_EQ(here["objects"][1]["model"], "/models/box.obj");
    const auto there = with_models_beside("/mine/objects.json", document);
    EXPECT_EQ(there["objects"][0]["model"], "/mine/box.obj");
}

TEST(Objects, ReadsThePlaneUnderABall) {
    const auto plan = parse_json(
                          R"({"objects":[
        {"name":"ball","method":"sphere","radius_m":0.05},
        {"name":"plank","method":"plane","under":"ball"},
        {"name":"wall","method":"plane","in":"scene"}]})",
                          "objects.json"
    )
                          .and_then(read_tracking_plan);
    ASSERT_TRUE(plan) << to_text(plan.error());
    EXPECT_EQ(std::get<PlaneSettings>(plan->objects[1].settings).under, "ball");
    EXPECT_TRUE(std::get<PlaneSettings>(plan->objects[2].settings).under.empty());
}

struct Wrong {
    const char* text;
    const char* field;
    const char* cure;
};

class WrongObjects : public testing::TestWithParam<Wrong> {};

TEST_P(WrongObjects, NamesTheFieldAndTheCure) {
    const Error error = error_of(GetParam().text);
    EXPECT_EQ(error.field, GetParam().field);
    EXPECT_THAT(error.cure, HasSubstr(GetParam().cure));
}

INSTANTIATE_TEST_SUITE_P(
    All,
    WrongObjects,
    testing::Values(
        Wrong{R"({"objects":[]})", "objects", "1 to 64"},
        Wrong{R"({"object":[]})", "object", "did you mean objects"},
        Wrong{R"([])", "", "objects"},
        Wrong{R"({"objects":[3]})", "objects[0]", "name, method"},
        Wrong{R"({"objects":[{"method":"sphere"}]})", "objects[0].name", "text"},
        Wrong{
            R"({"objects":[{"name":"a","method":"plane","under":"b","in":"scene"}]})",
            "objects[0].under",
            "one of them"},
        Wrong{
            R"({"objects":[{"name":"a","method":"plane","under":""}]})",
            "objects[0].under",
            "name of the ball"},
        Wrong{
            R"({"objects":[{"name":"b","method":"sphere"},{"name":"a","method":"plane","under":"c"}]})",
            "objects[1].under",
            "b"},
        Wrong{
            R"({"objects":[{"name":"=1+1","method":"change"}]})", "objects[0].name", "begin with"},
        Wrong{R"({"objects":[{"name":"a","method":"shpere"}]})", "objects[0].method", "sphere"},
        Wrong{
            R"({"objects":[{"name":"a","method":"texture","box":[10.7,5,20,20]}]})",
            "objects[0].box",
            "whole pixels"},
        Wrong{
            R"({"objects":[{"name":"a","method":"colour","click":[10,5.5]}]})",
            "objects[0].click",
            "whole pixels"},
        Wrong{
            R"({"objects":[{"name":"a","method":"sphere","radius":1}]})",
            "objects[0].radius",
            "radius_m"},
        Wrong{
            R"({"objects":[{"name":"a","method":"sphere","radius_m":"1"}]})",
            "objects[0].radius_m",
            "number"},
        Wrong{
            R"({"objects":[{"name":"a","method":"sphere","radius_m":-1}]})",
            "objects[0].radius_m",
            "above 0"},
        Wrong{
            R"({"objects":[{"name":"a","method":"sphere","min_radius_m":0.4}]})",
            "objects[0].min_radius_m",
            "<"},
        Wrong{
            R"({"objects":[{"name":"a","method":"change","radius_m":1}]})",
            "objects[0].radius_m",
            "method"},
        Wrong{
            R"({"objects":[{"name":"a","method":"change"},{"name":"a","method":"change"}]})",
            "objects[1].name",
            "own"},
        Wrong{R"({"objects":[{"name":"a","name":"b","method":"change"}]})", "objects.json", "once"},
        Wrong{R"({"objects":[)", "objects.json", "correct"},
        Wrong{
            R"({"objects":[{"name":"a","method":"sphere","radius_m":1e999}]})",
            "objects.json",
            "correct"}
    )
);

}  // namespace
}  // namespace kinectlab::experiments
