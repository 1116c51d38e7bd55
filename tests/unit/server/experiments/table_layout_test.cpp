#include <gtest/gtest.h>

#include "server/experiments/trajectory_table.hpp"

namespace kinectlab::experiments {
namespace {

TEST(TableLayout, RefusesWhatItDoesNotKnow) {
    EXPECT_EQ(parse_table_layout("q=1", "").error().field, "--columns");
    EXPECT_EQ(parse_table_layout("t=", "").error().field, "--columns");
    EXPECT_EQ(parse_table_layout("t=1,t=2", "").error().field, "--columns");
    EXPECT_EQ(parse_table_layout("", "inch").error().field, "--units");
    EXPECT_EQ(parse_table_layout("", "t=m").error().field, "--units");
    EXPECT_EQ(parse_table_layout("", "x=ms").error().field, "--units");
}

TEST(TableLayout, OneUnitIsThatOfAllPlaces) {
    const std::array<std::string, 4> expected{"ns", "mm", "mm", "mm"};
    EXPECT_EQ(parse_table_layout("", "mm,t=ns").value().unit, expected);
    EXPECT_EQ(parse_table_layout("", "pixels").value().unit[3], "px");
}

}  // namespace
}  // namespace kinectlab::experiments
