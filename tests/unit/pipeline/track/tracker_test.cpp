#include "pipeline/track/tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinectlab {
namespace {

using testing::HasSubstr;

ObjectSpec object(std::string name, std::string method = "sphere") {
    ObjectSpec spec;
    spec.name = std::move(name);
    spec.method = std::move(method);
    return spec;
}

Error refusal(std::vector<ObjectSpec> objects) {
    const auto trackers = make_trackers(RgbdCamera{}, objects);
    EXPECT_FALSE(trackers);
    return trackers ? Error{} : trackers.error();
}

TEST(MakeTrackers, OneForEachMethodInUse) {
    const std::vector objects{object("a"), object("b", "change"), object("c")};
    const auto trackers = make_trackers(RgbdCamera{}, objects);
    ASSERT_TRUE(trackers);
    EXPECT_EQ(trackers->size(), 2U);
}

TEST(MakeTrackers, RefusesAnEmptyList) {
    EXPECT_EQ(refusal({}).field, "objects");
}

TEST(MakeTrackers, NamesTheNearestMethod) {
    const Error error = refusal({object("bob", "spere")});
    EXPECT_EQ(error.field, "objects[0].method");
    EXPECT_THAT(error.message, HasSubstr("\"spere\""));
    EXPECT_THAT(error.cure, HasSubstr("nearest is \"sphere\""));
    EXPECT_THAT(refusal({object("bob", "chnge")}).cure, HasSubstr("nearest is \"change\""));
}

TEST(MakeTrackers, RefusesRadiiThatAreNone) {
    for (const double radius : {0.0, -0.05, 5.0, std::nan("")}) {
        auto bob = object("bob");
        bob.radius_m = radius;
        EXPECT_EQ(refusal({bob}).field, "objects[0].radius_m") << radius;
    }
    auto bob = object("bob");
    bob.min_radius_m = 0.2;
    bob.max_radius_m = 0.1;
    EXPECT_EQ(refusal({bob}).field, "objects[0].min_radius_m");
}

TEST(MakeTrackers, RefusesNamesThatAreEmptyOrThereTwice) {
    EXPECT_EQ(refusal({object("")}).field, "objects[0].name");
    EXPECT_EQ(refusal({object("a"), object("b"), object("a")}).field, "objects[2].name");
}

}  // namespace
}  // namespace kinectlab
