#include "pipeline/track/tracker.hpp"

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

ObjectSpec object(std::string name, MethodSettings settings = SphereSettings{}) {
    return {std::move(name), settings};
}

Error refusal(std::vector<ObjectSpec> objects) {
    const auto trackers = make_trackers(RgbdCamera{}, objects);
    EXPECT_FALSE(trackers);
    return trackers ? Error{} : trackers.error();
}

TEST(MakeTrackers, OneForEachMethodInUse) {
    const std::vector objects{object("a"), object("b", ChangeTrackSettings{}), object("c")};
    const auto trackers = make_trackers(RgbdCamera{}, objects);
    ASSERT_TRUE(trackers);
    EXPECT_EQ(trackers->size(), 2U);
}

TEST(MakeTrackers, RefusesAnEmptyList) {
    EXPECT_EQ(refusal({}).field, "objects");
}

TEST(MakeTrackers, RefusesRadiiThatAreNone) {
    for (const double radius : {0.0, -0.05, 5.0, std::nan("")}) {
        const auto bob = object("bob", SphereSettings{.radius_m = radius});
        EXPECT_EQ(refusal({bob}).field, "objects[0].radius_m") << radius;
    }
    const auto bob = object("bob", SphereSettings{.min_radius_m = 0.2, .max_radius_m = 0.1});
    EXPECT_EQ(refusal({bob}).field, "objects[0].min_radius_m");
}

TEST(MakeTrackers, RefusesNamesThatAreEmptyOrThereTwice) {
    EXPECT_EQ(refusal({object("")}).field, "objects[0].name");
    EXPECT_EQ(refusal({object("a"), object("b"), object("a")}).field, "objects[2].name");
}

}  // namespace
}  // namespace kinectlab
