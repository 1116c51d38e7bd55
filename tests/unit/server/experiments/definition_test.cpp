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
    auto definition = load_definition(share_dir() / "experiments", "pendulum");
    EXPECT_TRUE(definition) << to_text(definition.error());
    return definition.value_or(Definition{});
}

TEST(Definition, FillsInTheDefaults) {
    const auto values = validate(pendulum(), {{"length_m", 0.8}});
    ASSERT_TRUE(values);
    EXPECT_EQ(values->size(), pendulum().parameters.size());
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

TEST(Definition, WhatASimulatedRigHasIsNoGuessOfARealOne) {
    const auto simulated = validate(pendulum(), {}, RigKind::simulated);
    const auto real = validate(pendulum(), {}, RigKind::real);
    ASSERT_TRUE(simulated && real);
    for (const char* name : {"bob_density_kg_m3", "air_density_kg_m3", "string_mass_kg"}) {
        EXPECT_EQ(simulated->count(name), 1u) << name;
        EXPECT_EQ(real->count(name), 0u) << name;
    }
    auto document = to_json(pendulum());
    document["parameters"][0]["simulated_default"] = 99;
    const auto outside = read_definition(document);
    ASSERT_FALSE(outside);
    EXPECT_EQ(outside.error().field, "parameters[0].simulated_default");
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
    const auto definition = load_definition(share_dir() / "experiments", "pendulm");
    ASSERT_FALSE(definition);
    EXPECT_THAT(definition.error().cure, HasSubstr("pendulum"));
}

nlohmann::json pendulum_document() {
    return to_json(pendulum());
}

/// The error that a changed definition is refused with; fails the test where it is taken.
template <class Change>
Error refusal(Change&& change) {
    auto document = pendulum_document();
    change(document);
    const auto definition = read_with_schema(document);
    EXPECT_FALSE(definition) << document.dump();
    return definition ? Error{} : definition.error();
}

TEST(Definition, AUnitThatDoesNotFitTheNameIsRefused) {
    const auto error = refusal([](auto& d) { d["parameters"][0]["unit"] = "cm"; });
    EXPECT_EQ(error.field, "parameters[0].unit");
    EXPECT_THAT(error.message, HasSubstr("cm"));
}

TEST(Definition, AnAnalysisThatDoesNotFitTheObjectsIsRefused) {
    const auto error = refusal([](auto& d) {
        d["objects"].push_back({{"name", "other"}, {"method", "sphere"}});
        d["analysis"].erase("objects");
    });
    EXPECT_EQ(error.field, "analysis.objects");
    EXPECT_THAT(error.message, HasSubstr("takes 1"));
}

TEST(Definition, NamesThatNothingHasAreRefusedWithTheNearest) {
    EXPECT_EQ(
        refusal([](auto& d) { d["analysis"]["method"] = "pendlum"; }).field, "analysis.method"
    );
    EXPECT_EQ(
        refusal([](auto& d) { d["analysis"]["settings"]["lenght_m"] = 1; }).field,
        "analysis.settings.lenght_m"
    );
    EXPECT_EQ(
        refusal([](auto& d) { d["sequence"][4]["to"]["parameter"] = "amplitude"; }).field,
        "sequence[4].to.parameter"
    );
    EXPECT_EQ(refusal([](auto& d) { d["plots"][0] = "postion"; }).field, "plots[0]");
    EXPECT_EQ(
        refusal([](auto& d) { d["acceptance"][0]["fact"] = "perids"; }).field, "acceptance[0].fact"
    );
    const auto step = refusal([](auto& d) { d["sequence"][0]["do"] = "halt"; });
    EXPECT_EQ(step.field, "sequence[0].do");
}

TEST(Definition, AnalysisSettingsMustHaveTheRightUnitAndRange) {
    EXPECT_EQ(
        refusal([](auto& d) {
            d["analysis"]["settings"]["length_m"] = {{"parameter", "duration_s"}};
        }).field,
        "analysis.settings.length_m.parameter"
    );
    EXPECT_EQ(
        refusal([](auto& d) { d["analysis"]["settings"]["length_m"] = -1; }).field,
        "analysis.settings.length_m"
    );
}

TEST(Definition, AnApparatusThatNoRigHasIsRefusedWithTheNearest) {
    const auto error = refusal([](auto& d) { d["apparatus"] = "pendulm"; });
    EXPECT_EQ(error.field, "apparatus");
    EXPECT_THAT(error.cure, HasSubstr("pendulum"));
}

TEST(Definition, ADisplacementOutOfReachIsRefused) {
    const auto by_parameter = refusal([](auto& d) { d["parameters"][3]["max"] = 80; });
    EXPECT_EQ(by_parameter.field, "sequence[4].to");
    EXPECT_THAT(by_parameter.message, HasSubstr("80°"));
    EXPECT_THAT(by_parameter.cure, HasSubstr("narrow the range of amplitude_deg"));
    const auto in_radians = refusal([](auto& d) { d["sequence"][4]["to"] = 10; });
    EXPECT_EQ(in_radians.field, "sequence[4].to");
    EXPECT_THAT(in_radians.cure, HasSubstr("1.047"));
}

TEST(Definition, AnObjectMustBeTracked) {
    const auto error = refusal([](auto& d) { d["objects"] = nlohmann::json::array(); });
    EXPECT_EQ(error.field, "objects");
    EXPECT_THAT(error.message, HasSubstr("empty"));
}

TEST(Definition, TheSceneHasToBeLearned) {
    const auto error = refusal([](auto& d) {
        for (auto& step : d["sequence"])
            step.erase("learn");
    });
    EXPECT_EQ(error.field, "sequence");
}

TEST(Definition, TextThatCouldCarryMoreThanTextIsRefusedWithItsPlace) {
    for (const char* text :
         {"one\ntwo <script>alert(1)</script>",
          "a </p>",
          "a [link](https://example.org)",
          "$\\href{javascript:alert(1)}{x}$",
          "$\\def\\x{1}$",
          "$\\includegraphics{a}$",
          "$x$ and $y",
          "$x$ costs 5 $\n\nand 6 $",
          "$x$$",
          "$$x$ and so on",
          "$\\frac{a}{b$ and $}$",
          "$a}$",
          "$$\\sqrt{x$$",
          "$\\left( x$",
          "$x \\right)$",
          "a\x01b"}) {
        const auto error = refusal([&](auto& d) { d["theory"] = text; });
        EXPECT_EQ(error.field, "theory") << text;
        EXPECT_THAT(error.message, HasSubstr("line ")) << text;
    }
    auto document = pendulum_document();
    document["theory"] = "If a < b then $\\frac{a}{b} < 1$.\n\n$$\\sqrt{x}\\,\\alpha$$";
    EXPECT_TRUE(read_with_schema(document));
}

TEST(Definition, NoTextOfItMayCarryAScript) {
    const std::string script = "See <script>alert(1)</script>";
    EXPECT_EQ(refusal([&](auto& d) { d["title"] = script; }).field, "title");
    EXPECT_EQ(
        refusal([&](auto& d) { d["parameters"][0]["help"] = script; }).field, "parameters[0].help"
    );
    EXPECT_EQ(
        refusal([&](auto& d) { d["acceptance"][0]["reason"] = script; }).field,
        "acceptance[0].reason"
    );
}

TEST(Definition, AnAcceptanceCheckThatNothingPassesIsRefused) {
    const auto error = refusal([](auto& d) {
        d["acceptance"][0]["min"] = 10;
        d["acceptance"][0]["max"] = 3;
    });
    EXPECT_EQ(error.field, "acceptance[0].min");
}

TEST(Definition, TheSchemaRefusesWhatNoOtherCheckLooksAt) {
    EXPECT_EQ(refusal([](auto& d) { d["id"] = "../etc/passwd"; }).field, "[id]");
    EXPECT_FALSE(refusal([](auto& d) { d["title"] = std::string(500, 'x'); }).message.empty());
}

TEST(Definition, AParameterWithoutDefaultIsGivenOnlyIfSomebodyGivesIt) {
    auto document = pendulum_document();
    document["parameters"].push_back(
        {{"name", "thread_mass_kg"},
         {"unit", "kg"},
         {"min", 0},
         {"max", 1},
         {"step", 0.001},
         {"default", nullptr},
         {"help", "Of the string."}}
    );
    const auto definition = read_with_schema(document);
    ASSERT_TRUE(definition) << to_text(definition.error());
    EXPECT_FALSE(validate(*definition, {})->contains("thread_mass_kg"));
    EXPECT_EQ(validate(*definition, {{"thread_mass_kg", 0.01}})->at("thread_mass_kg"), 0.01);
}

TEST(Definition, AllThatComeWithTheProgramAreRight) {
    const auto all = load_definitions(share_dir() / "experiments");
    ASSERT_TRUE(all) << to_text(all.error());
    for (const auto& definition : *all) {
        const auto values = validate(definition, {});
        ASSERT_TRUE(values) << definition.id << ": " << to_text(values.error());
        EXPECT_EQ(plan_for(definition, *values).objects.size(), definition.objects.size());
        EXPECT_FALSE(definition.theory.empty()) << definition.id;
        EXPECT_TRUE(value_of(definition.duration, *values)) << definition.id;
    }
}

}  // namespace
}  // namespace kinectlab::experiments
