#include "server/experiments/table_text.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "server/experiments/trajectory_table.hpp"

namespace kinectlab::experiments {
namespace {

std::string rows(const char* form, int count = 10) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += fmt::format(fmt::runtime(form), i);
    return text;
}

Result<TrajectoryTable> read(
    const std::string& text, const char* columns = "", const char* units = ""
) {
    return read_trajectory_table(text, parse_table_layout(columns, units).value(), "table");
}

/// Ten rows, one each second, at 1.25, 2.5 m.
void expect_ten(const std::string& text, const char* columns = "", const char* units = "") {
    const auto got = read(text, columns, units);
    ASSERT_TRUE(got) << to_text(got.error()) << '\n' << text.substr(0, 60);
    const auto& samples = got->trajectory.samples;
    ASSERT_EQ(samples.size(), 10U);
    EXPECT_EQ(samples[9].t - samples[0].t, 9'000'000'000);
    EXPECT_EQ(samples[9].p_lab, Eigen::Vector3d(1.25, 0.0, 2.5));
}

std::string in_utf16(const std::string& text, bool little) {
    std::string bytes = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char c : text)
        bytes += little ? std::string{c, '\0'} : std::string{'\0', c};
    return bytes;
}

TEST(TableText, TimesMayCountFromAnyMoment) {
    expect_ten("t,x,y\n" + rows("176000000{}.25,1.25,2.5\n"));
    expect_ten("t,x,y\n" + rows("70000000000000{},1.25,2.5\n"));
    const auto got = read("t_ns,x,y\n" + rows("176000000012345678{},1.25,2.5\n"));
    ASSERT_TRUE(got) << to_text(got.error());
    EXPECT_EQ(got->trajectory.samples[3].t, 1'760'000'000'123'456'783);
}

TEST(TableText, OwnPosesWithLostRowsAreRead) {
    const std::string text = "t_ns,object,status,x,y,z,qx\n" + rows("10{},bob,lost,,,,\n", 2) +
                             rows("11{},bob,tracked,1,2,3,\n") + "120,bob,lost,,,,\n";
    const auto got = read(text, "t=t_ns,x=x,y=y,z=z", "t=ns");
    ASSERT_TRUE(got) << to_text(got.error());
    const auto& samples = got->trajectory.samples;
    ASSERT_EQ(samples.size(), 13U);
    EXPECT_EQ(samples[0].t, 100);
    EXPECT_EQ(samples[0].status, TrackStatus::lost);
    EXPECT_EQ(samples[2].p_lab, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_EQ(samples[12].status, TrackStatus::lost);
}

TEST(TableText, SpacesMayStandInHeadsBetweenSpaces) {
    const auto got = read("t (s) x (m) y (cm) z [ mm ]\n" + rows("{} 1 2 3\n"));
    ASSERT_TRUE(got) << to_text(got.error());
    EXPECT_EQ(got->trajectory.samples[0].p_lab, Eigen::Vector3d(1.0, 0.02, 0.003));
    expect_ten("t (s), x (m), y (m)\n" + rows("{} 1.25 2.5\n"));
    expect_ten("time of it x of bob y of bob\n" + rows("{} 1.25 2.5\n"), "t=1,x=2,y=3");
    EXPECT_EQ(
        read("t of x of y of\n" + rows("{} 1.25 2.5\n")).error().message,
        "has 6 heads over 3 columns: t, of, x, of, y, of"
    );
}

TEST(TableText, WhatIsNoRowAtTheEndIsLeftOutWithAWarning) {
    const std::string table = "t;x;y\n" + rows("{},0;1,25;2,5\n");
    for (const char* tail : {"10,", "10,0;1,2", "10,0;", "mean, of all\n", "10,0;a;b\n", ";;\n"}) {
        expect_ten(table + tail);
        const auto got = read(table + tail);
        ASSERT_TRUE(got) << tail;
        ASSERT_EQ(got->warnings.size(), 1U) << tail;
        EXPECT_TRUE(got->warnings[0].starts_with("left out the table's last line,"))
            << got->warnings[0];
    }
    const auto two = read(table + "Statistics\nmean 3, most 4\n");
    ASSERT_TRUE(two);
    EXPECT_TRUE(two->warnings.at(0).starts_with("left out the table's last 2 lines,"))
        << two->warnings[0];
    EXPECT_EQ(
        read(table + "pause\n10,0;1,25;2,5\n").error().message, "line 12: 'pause' is no number"
    );
}

TEST(TableText, LineEndsEncodingsAndQuotes) {
    const std::string table = "t,x,y\n" + rows("{},1.25,2.5\n");
    std::string old = table;
    std::replace(old.begin(), old.end(), '\n', '\r');
    expect_ten(old);
    expect_ten(in_utf16(table, true));
    expect_ten(in_utf16(table, false));
    expect_ten("t,x,y\n" + rows("\"{},0\",\"1,25\",\"2,5\"\n"));
    EXPECT_EQ(read(in_utf16(table, true).substr(2)).error().message, "is no text in UTF-8");
    EXPECT_EQ(to_utf8("\xFF\xFE\xB5\x03\xB5"), "\xCE\xB5");
}

TEST(TableText, ThousandsAreNotTakenForDecimals) {
    const auto got = read("t,x,y\n" + rows("{}.5,\"1,250\",2\n"));
    ASSERT_FALSE(got);
    EXPECT_TRUE(got.error().message.starts_with("line 2 has a decimal point"))
        << got.error().message;
}

}  // namespace
}  // namespace kinectlab::experiments
