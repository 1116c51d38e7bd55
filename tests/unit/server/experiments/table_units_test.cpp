#include "server/experiments/table_units.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "server/experiments/trajectory_table.hpp"

namespace kinectlab::experiments {
namespace {

/// Ten rows 2, 4, 6 … in the first column, 3 in the second, 5 in the third.
std::string table(const std::string& head, const char* separator = ";") {
    std::string text = head + "\n";
    for (int i = 1; i <= 10; ++i)
        text += fmt::format("{1}{0}3{0}5\n", separator, 2 * i);
    return text;
}

Result<TrajectoryTable> read(
    const std::string& text, const char* columns = "", const char* units = ""
) {
    return read_trajectory_table(text, parse_table_layout(columns, units).value(), "table");
}

void expect_read(
    const Result<TrajectoryTable>& got, std::int64_t step_ns, double x, double y, const char* units
) {
    ASSERT_TRUE(got) << to_text(got.error());
    const auto& samples = got->trajectory.samples;
    ASSERT_EQ(samples.size(), 10U);
    EXPECT_EQ(samples[1].t - samples[0].t, step_ns);
    EXPECT_NEAR(samples[0].p_lab.x(), x, 1e-12);
    EXPECT_NEAR(samples[0].p_lab.z(), y, 1e-12);
    EXPECT_EQ(got->units, units);
}

TEST(TableUnits, AHeadFallsIntoNameAndUnit) {
    const std::vector<std::array<const char*, 3>> heads{
        {"\"Time (s)\"", "time", "s"},
        {"t [ms]", "t", "ms"},
        {"x/cm", "x", "cm"},
        {"X, mm", "x", "mm"},
        {"x (left) (cm)", "x", "cm"},
        {"t_ns", "t", "ns"},
        {"x_in", "x_in", ""},
        {"x_left", "x_left", ""},
        {"x ()", "x", ""},
        {"x (", "x", ""},
    };
    for (const auto& [cell, name, unit] : heads) {
        EXPECT_EQ(parse_head(cell).name, name) << cell;
        EXPECT_EQ(parse_head(cell).unit, unit) << cell;
    }
}

TEST(TableUnits, OfTheHeadAreUsedWhereNoneAreGiven) {
    expect_read(
        read(table("t (s);x (cm);y (cm)")),
        2'000'000'000,
        0.03,
        0.05,
        "t in s (head), x in cm (head), y in cm (head)"
    );
    expect_read(
        read(table("t [ms];x/mm;y, in")),
        2'000'000,
        3e-3,
        5 * 0.0254,
        "t in ms (head), x in mm (head), y in in (head)"
    );
    expect_read(
        read(table("X (\xC2\xB5s);a (m);b (m)"), "t=X,x=a,y=b"),
        2'000,
        3.0,
        5.0,
        "t in us (head), x in m (head), y in m (head)"
    );
    expect_read(read(table("t;x;y")), 2'000'000'000, 3.0, 5.0, "t in s, x in m, y in m");
    expect_read(
        read(table("# t (min) x (cm) y (cm)", " "), "t=1,x=2,y=3"),
        120'000'000'000,
        0.03,
        0.05,
        "t in min (head), x in cm (head), y in cm (head)"
    );
}

TEST(TableUnits, GivenOnesGoBeforeThoseOfTheHead) {
    expect_read(
        read(table("t (frames);x (cm);y (cm)"), "", "t=ms,x=mm"),
        2'000'000,
        3e-3,
        0.05,
        "t in ms, x in mm, y in cm (head)"
    );
}

TEST(TableUnits, PixelsAreThousandthsOfNoMetre) {
    for (const char* units : {"px", "x=px,y=px", "t=ms,x=px,y=px,z=px"}) {
        const auto got = read(table("t;x;y"), "", units);
        ASSERT_TRUE(got) << units;
        EXPECT_TRUE(got->pixels);
        EXPECT_EQ(got->trajectory.samples[0].p_lab.x(), 3e-3);
    }
    EXPECT_TRUE(read(table("t;x (pixels);y (px)"))->pixels);
    EXPECT_FALSE(read(table("t;x;y"), "", "cm")->pixels);
    EXPECT_EQ(read(table("t;x (px);y (cm)")).error().message, "has some places in px and some not");
    EXPECT_FALSE(read(table("t;x;y"), "", "px,y=cm"));
    EXPECT_FALSE(read(table("t;x;y"), "", "x=px"));
}

TEST(TableUnits, UnknownOnesOfUsedColumnsAreRefused) {
    const auto furlong = read(table("t (s);x (furlong);y (cm)"));
    ASSERT_FALSE(furlong);
    EXPECT_EQ(
        furlong.error().message,
        "column 'x (furlong)' has the unit 'furlong', which is not one for x"
    );
    EXPECT_NE(to_text(furlong.error()).find("--units"), std::string::npos);
    EXPECT_FALSE(read(table("t (cm);x (cm);y (cm)")));
    EXPECT_FALSE(read(table("t;x (s);y (m)")));
    // One place with a unit and one without may be a hundredfold apart.
    EXPECT_FALSE(read(table("t;x (cm);y")));
    EXPECT_TRUE(read(table("t;x (cm);y"), "", "y=cm"));
}

}  // namespace
}  // namespace kinectlab::experiments
