#include "server/api/body.hpp"

#include <gtest/gtest.h>

namespace kinectlab::api {
namespace {

constexpr TimeNs kNine = 1'795'338'000 * kNsPerSecond;  // 2026-11-22T09:00:00Z

TEST(ParseTime, TakesAnyOffsetAndFraction) {
    EXPECT_EQ(parse_time("2026-11-22T09:00:00Z"), kNine);
    EXPECT_EQ(parse_time("2026-11-22T10:30:00+01:30"), kNine);
    EXPECT_EQ(parse_time("2026-11-22T00:00:00-09:00"), kNine);
    EXPECT_EQ(parse_time("2026-11-22T09:00:00.25Z"), kNine + kNsPerSecond / 4);
    EXPECT_EQ(parse_time("1970-01-01T00:00:00Z"), 0);
    EXPECT_EQ(parse_time("2024-02-29T00:00:00Z"), 1'709'164'800 * kNsPerSecond);
}

TEST(ParseTime, RefusesEverythingElse) {
    for (const char* text :
         {"",
          "now",
          "2026-11-22",
          "2026-11-22T09:00:00",
          "2026-11-22 09:00:00Z",
          "2026-02-29T09:00:00Z",
          "2026-13-01T09:00:00Z",
          "2026-11-22T24:00:00Z",
          "2026-11-22T09:60:00Z",
          "2026-11-22T09:00:00+1:00",
          "2026-11-22T09:00:00Zulu",
          "9999-01-01T00:00:00Z",
          "2026-11-22T09:00:00+25:00",
          "-026-11-22T09:00:00Z"})
        EXPECT_FALSE(parse_time(text)) << text;
}

TEST(ParseId, TakesPositiveWholeNumbersOnly) {
    EXPECT_EQ(parse_id("12"), 12);
    for (const char* text : {"", "0", "-1", "+1", "1x", " 1", "1.0", "99999999999999999999"})
        EXPECT_FALSE(parse_id(text)) << text;
}

TEST(Query, NamesWhatIsWrong) {
    net::Request request;
    request.query = {{"limit", "x"}, {"mine", "1"}, {"befor", "3"}};
    EXPECT_EQ(query_integer(request, "limit", 1, 200).error().field, "limit");
    EXPECT_EQ(query_flag(request, "mine").error().field, "mine");
    const auto unknown = check_query(request, {"limit", "mine", "before"});
    EXPECT_EQ(unknown.error().field, "befor");
    EXPECT_EQ(unknown.error().cure, "did you mean before? Valid: limit, mine, before");
    EXPECT_FALSE(query_integer(request, "other", 1, 2)->has_value());
    request.repeated = "limit";
    EXPECT_EQ(check_query(request, {"limit", "mine", "befor"}).error().field, "limit");
}

TEST(ReadBody, NeedsJsonThatIsDeclared) {
    net::Request request;
    request.body = "{}";
    EXPECT_EQ(read_body(request).error().field, "Content-Type");
    request.headers = {{"content-type", "application/json; charset=utf-8"}};
    EXPECT_TRUE(read_body(request));
    for (const char* text : {"", "{", "{\"a\":1,\"a\":2}", "{} {}", "\xff"}) {
        request.body = text;
        EXPECT_EQ(read_body(request).error().code, ErrorCode::bad_data) << text;
    }
}

}  // namespace
}  // namespace kinectlab::api
