#include "server/experiments/recorded_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiments/share_dir.hpp"
#include "tests/unit/pipeline/sensor/scratch_folder.hpp"

namespace kinectlab::experiments {
namespace {

using test::ScratchFolder;
using test::write_text;

Definition pendulum() {
    return load_definition(experiments::share_dir() / "experiments", "pendulum").value();
}

TEST(RecordedSettings, StandBetweenTheGivenAndTheDefaults) {
    const ScratchFolder recording;
    write_text(
        recording / "experiment.json",
        R"({"experiment":"pendulum","parameters":{"length_m":0.8,"bob_radius_m":0.03,"gravity":1.62}})"
    );
    const auto values = with_recorded_settings(pendulum(), {{"length_m", 0.9}}, recording.path());
    ASSERT_TRUE(values) << to_text(values.error());
    EXPECT_EQ(values->at("length_m"), 0.9);
    EXPECT_EQ(values->at("bob_radius_m"), 0.03);
    EXPECT_EQ(values->at("latitude_deg"), 45);
    EXPECT_FALSE(values->contains("gravity"));
    EXPECT_EQ(recorded_truth(pendulum(), recording.path()), (Values{{"gravity", 1.62}}));
}

TEST(RecordedSettings, AreNotNeeded) {
    const ScratchFolder recording;
    const auto values = with_recorded_settings(pendulum(), {}, recording.path());
    ASSERT_TRUE(values);
    EXPECT_EQ(values->at("length_m"), 1.0);
    EXPECT_TRUE(recorded_truth(pendulum(), recording.path()).empty());
}

TEST(RecordedSettings, AFileThatMakesNoSenseIsAnError) {
    for (const char* text :
         {"{",
          R"({"experiment":"spring"})",
          R"({"experiment":"pendulum","parameters":{"lenght_m":1}})",
          R"({"experiment":"pendulum","parameters":{"length_m":-1}})"}) {
        const ScratchFolder recording;
        write_text(recording / "experiment.json", text);
        const auto values = with_recorded_settings(pendulum(), {}, recording.path());
        ASSERT_FALSE(values) << text;
        EXPECT_EQ(values.error().code, ErrorCode::bad_data);
        EXPECT_TRUE(recorded_truth(pendulum(), recording.path()).empty());
        EXPECT_NE(to_text(values.error()).find("experiment.json"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace kinectlab::experiments
