#include "server/net/message.hpp"

#include <gtest/gtest.h>

namespace kinectlab::net {
namespace {

TEST(ParseTarget, SplitsAndDecodes) {
    const auto target = parse_target("/rigs/rig%201/live?ticket=a%2Bb&from=x+y&flag");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/rigs/rig%201/live");
    EXPECT_EQ(target->segments, (std::vector<std::string>{"rigs", "rig 1", "live"}));
    EXPECT_EQ(target->query.at("ticket"), "a+b");
    EXPECT_EQ(target->query.at("from"), "x y");
    EXPECT_EQ(target->query.at("flag"), "");
}

TEST(ParseTarget, KeepsTheFirstOfARepeatedNameAndSaysThatItIs) {
    const auto target = parse_target("/runs?limit=1&mine&limit=2");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->query.at("limit"), "1");
    EXPECT_EQ(target->repeated, "limit");
    EXPECT_EQ(parse_target("/runs?limit=1&mine")->repeated, "");
}

TEST(ParseTarget, AnEncodedSlashStaysInsideItsSegment) {
    const auto target = parse_target("/a%2Fb/c");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->segments, (std::vector<std::string>{"a/b", "c"}));
}

TEST(ParseTarget, RefusesWhatIsBadlyEncoded) {
    for (const char* text : {"", "a", "*", "http://x/", "/%", "/%4", "/%zz", "/%00", "/a?b=%g0"})
        EXPECT_FALSE(parse_target(text)) << text;
}

TEST(Request, FindsHeadersWhateverTheirCaseAndCookiesByName) {
    Request request;
    request.headers = {{"cOOKIE", "a=1; session=x=y ;b=2"}, {"Host", "here"}};
    EXPECT_EQ(request.header("host"), "here");
    EXPECT_FALSE(request.header("Hos"));
    EXPECT_EQ(request.cookie("session"), "x=y");
    EXPECT_EQ(request.cookie("b"), "2");
    EXPECT_FALSE(request.cookie("sess"));
}

}  // namespace
}  // namespace kinectlab::net
