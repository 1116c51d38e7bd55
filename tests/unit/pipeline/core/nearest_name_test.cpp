#include "pipeline/core/nearest_name.hpp"

#include <gtest/gtest.h>

#include "pipeline/core/file_ending.hpp"
#include "pipeline/core/number_text.hpp"

namespace kinectlab {
namespace {

const std::vector<std::string> kSmoothing{"moving_least_squares", "none"};
const std::vector<std::string> kMethods{"sphere", "change", "surface_patch", "colour", "cylinder"};

TEST(NearestName, IsWhatWasMisspelt) {
    EXPECT_EQ(nearest_name("spere", kMethods), "sphere");
    EXPECT_EQ(nearest_name("color", kMethods), "colour");
    EXPECT_EQ(nearest_name("Sphere", kMethods), "sphere");
    EXPECT_EQ(nearest_name("moving-least-squares", kSmoothing), "moving_least_squares");
    EXPECT_EQ(nearest_name("cyl", kMethods), "cylinder");
}

TEST(NearestName, KnowsInitialsAndOtherNames) {
    EXPECT_EQ(nearest_name("mls", kSmoothing), "moving_least_squares");
    EXPECT_EQ(nearest_name("MLS", kSmoothing), "moving_least_squares");
    EXPECT_EQ(nearest_name("sor", {"statistical", "none"}), "statistical");
    EXPECT_EQ(nearest_name("voxels", {"image_grid", "octree"}), "octree");
    EXPECT_EQ(nearest_name("ball", kMethods), "sphere");
}

TEST(NearestName, IsNoneWhereNoneIsNear) {
    EXPECT_EQ(nearest_name("gauss", kSmoothing), "");
    EXPECT_EQ(nearest_name("x", kMethods), "");
    EXPECT_EQ(nearest_name("", kMethods), "");
    EXPECT_EQ(nearest_name("x", {}), "");
    EXPECT_EQ(did_you_mean("gauss", kSmoothing), "valid: moving_least_squares, none");
    EXPECT_EQ(
        did_you_mean("mls", kSmoothing),
        "did you mean moving_least_squares? Valid: moving_least_squares, none"
    );
}

TEST(NumberText, IsAsAPersonWritesIt) {
    EXPECT_EQ(number_text(0.0), "0");
    EXPECT_EQ(number_text(5000.0), "5000");
    EXPECT_EQ(number_text(-1.0), "-1");
    EXPECT_EQ(number_text(0.2), "0.2");
    EXPECT_EQ(number_text(0.1F), "0.1");
    EXPECT_EQ(number_text(1e20), "1e+20");
}

TEST(FileEnding, IsInSmallLetters) {
    EXPECT_EQ(file_ending("a/Run.CSV"), ".csv");
    EXPECT_EQ(file_ending("scan.Pcd"), ".pcd");
    EXPECT_EQ(file_ending("none"), "");
}

}  // namespace
}  // namespace kinectlab
