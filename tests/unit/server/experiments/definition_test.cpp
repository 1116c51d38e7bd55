#include "server/experiments/definition.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/experiments/share_dir.hpp"

namespace kinectlab::experiments {
namespace {

using testing::HasSubstr;

Definition pendulum() {
    auto definition = load_definition(experiments::share_dir() / "experiments", "pendulum");
    EXPECT_TRUE(definition) << to_text(definition.error());
    return definition.value_or(Definition{});
}

TEST(Definition, FillsInTheDefaults) {
    const auto values = validate(pendulum(), {{"length_m", 0.8}});
    ASSERT_TRUE(values);
    EXPECT_EQ(values->size(), 8u);
    EXPECT_EQ(values->at("length_m"), 0.8);
    EXPECT_EQ(values->at("gravity"), 9.81);
    EXPECT_EQ(values->at("duration_s"), 30);
}

TEST(Definition, RefusesAnUnknownNameWithTheNearestValidOne) {
    const auto values = validate(pendulum(), {{"lenght_m", 0.8}});
    ASSERT_FALSE(values);
    EXPECT_EQ(values.error().field, "lenght_m");
    EXPECT_THAT(values.error().cure, HasSubstr("length_m"));
}

TEST(Definition, RefusesWhatIsOutOfRangeOrNoNumber) {
    for (const double wrong : {0.29, 1.51, -1.0, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        const auto values = validate(pendulum(), {{"length_m", wrong}});
        ASSERT_FALSE(values) << wrong;
        EXPECT_EQ(values.error().field, "length_m");
        EXPECT_THAT(values.error().cure, HasSubstr("from 0.3 to 1.5"));
    }
    EXPECT_TRUE(validate(pendulum(), {{"length_m", 0.3}}));
    EXPECT_TRUE(validate(pendulum(), {{"length_m", 1.5}}));
}

TEST(Definition, ARealRigHasNoGravityToSet) {
    const auto refused = validate(pendulum(), {{"gravity", 1.62}}, RigKind::real);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().field, "gravity");
    const auto values = validate(pendulum(), {}, RigKind::real);
    ASSERT_TRUE(values);
    EXPECT_EQ(values->count("gravity"), 0u);
    EXPECT_EQ(values->count("length_m"), 1u);
}

TEST(Definition, TheBobHasTheRunsRadius) {
    const auto objects = plan_for(pendulum(), {{"bob_radius_m", 0.03}}).objects;
    ASSERT_EQ(objects.size(), 1u);
    EXPECT_EQ(objects[0].name, "bob");
    EXPECT_EQ(method_of(objects[0]), "sphere");
    EXPECT_EQ(std::get<SphereSettings>(objects[0].settings).radius_m, 0.03);
}

TEST(Definition, GoesThroughJsonUnchanged) {
    const auto once = to_json(pendulum());
    const auto again = read_definition(once);
    ASSERT_TRUE(again) << to_text(again.error());
    EXPECT_EQ(to_json(*again), once);
}

TEST(Definition, ErrorsNameTheJsonPath) {
    auto document = to_json(pendulum());
    document["parameters"][1]["defualt"] = 1;
    auto definition = read_definition(document);
    ASSERT_FALSE(definition);
    EXPECT_EQ(definition.error().field, "parameters[1].defualt");
    EXPECT_THAT(definition.error().cure, HasSubstr("default"));

    document = to_json(pendulum());
    document["parameters"][0]["default"] = 99;
    definition = read_definition(document);
    ASSERT_FALSE(definition);
    EXPECT_EQ(definition.error().field, "parameters[0].default");

    document = to_json(pendulum());
    document["objects"][0]["radius_m"]["parameter"] = "nothing";
    definition = read_definition(document);
    ASSERT_FALSE(definition);
    EXPECT_EQ(definition.error().field, "objects[0].radius_m.parameter");
}

TEST(Definition, AnUnknownExperimentNamesTheNearest) {
    const auto definition = load_definition(experiments::share_dir() / "experiments", "pendulm");
    ASSERT_FALSE(definition);
    EXPECT_THAT(definition.error().cure, HasSubstr("pendulum"));
}

}  // namespace
}  // namespace kinectlab::experiments
