#include "server/lab/utc.hpp"

#include <gtest/gtest.h>

namespace kinectlab::lab {
namespace {

TEST(Utc, WritesRfc3339RoundedDown) {
    EXPECT_EQ(to_rfc3339(0), "1970-01-01T00:00:00Z");
    EXPECT_EQ(to_rfc3339(-1), "1969-12-31T23:59:59Z");
    EXPECT_EQ(to_rfc3339(1'709'209'800 * kNsPerSecond + 999'999'999), "2024-02-29T12:30:00Z");
}

TEST(Utc, SaysSpansAsPeopleDo) {
    EXPECT_EQ(span_text(45 * kNsPerSecond), "45 s");
    EXPECT_EQ(span_text(300 * kNsPerSecond), "5 min");
    EXPECT_EQ(span_text(3 * 3600 * kNsPerSecond), "3 h");
    EXPECT_EQ(span_text(30 * 86400 * kNsPerSecond), "30 days");
}

}  // namespace
}  // namespace kinectlab::lab
