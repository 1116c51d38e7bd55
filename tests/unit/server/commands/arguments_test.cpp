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
    EXPECT_EQ(
        parse_settings({"amplitude_deg=abc"}).error().cure,
        "give a number, e.g. --set amplitude_deg=0.8"
    );
}

TEST(Numbers, AreWholeWordsInTheirRange) {
    const auto check = check_number(0.1, 3600.0);
    for (const char* word : {"0.1", "3600", "1e2"})
        EXPECT_EQ(check(word), "") << word;
    for (const char* word : {"", "nan", "inf", "0", "-1", "3600.1", "1 s", "ten"})
        EXPECT_EQ(check(word), std::string("is ") + word + "; give a number from 0.1 to 3600");
}

}  // namespace
}  // namespace kinectlab::commands
