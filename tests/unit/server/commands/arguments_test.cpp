#include "server/commands/arguments.hpp"

#include <gtest/gtest.h>

namespace kinectlab::commands {
namespace {

TEST(Settings, AreNamesWithNumbers) {
    const auto values = parse_settings({"length_m=0.8", "latitude_deg=-33.5", "x=1e-3"});
    ASSERT_TRUE(values) << to_text(values.error());
    EXPECT_EQ(values->at("length_m"), 0.8);
    EXPECT_EQ(values->at("latitude_deg"), -33.5);
    EXPECT_EQ(values->at("x"), 1e-3);
}

TEST(Settings, OtherWordsAreRefused) {
    for (const char* word :
         {"", "length_m", "=1", "length_m=", "length_m=1m", "length_m= 1", "a=1,5"})
        EXPECT_FALSE(parse_settings({word})) << word;
    const auto twice = parse_settings({"a=1", "a=2"});
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().field, "a");
}

}  // namespace
}  // namespace kinectlab::commands
