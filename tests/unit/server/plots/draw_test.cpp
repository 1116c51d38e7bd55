#include "server/plots/draw.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/plots/axis.hpp"
#include "server/plots/plot_json.hpp"
#include "server/plots/report.hpp"

namespace kinectlab::plots {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const double kNan = std::numeric_limits<double>::quiet_NaN();

Plot some_plot() {
    return {
        "position",
        "Position <against> time",
        "t / s",
        "x / m",
        false,
        {{"measured", PlotMark::points, {0.0, 1.0, kNan, 3.0}, {0.1, kNan, 0.3, 0.2}, {}},
         {"fit", PlotMark::line, {0.0, 1.0, 2.0}, {0.1, 0.2, 0.15}, {}}}};
}

TEST(Axis, MarksAreRoundNumbersInside) {
    for (const auto& [low, high] :
         {std::pair(0.0, 10.0),
          std::pair(-1.7, 0.3),
          std::pair(9.80665, 9.80671),
          std::pair(1e6, 3e6)}) {
        const Axis axis = axis_for(low, high, 6);
        EXPECT_LT(axis.low, low);
        EXPECT_GT(axis.high, high);
        const auto marks = axis.marks();
        EXPECT_GE(marks.size(), 3U);
        EXPECT_LE(marks.size(), 14U);
        for (const double mark : marks) {
            EXPECT_GE(mark, axis.low - 1e-9 * axis.step);
            EXPECT_LE(mark, axis.high + 1e-9 * axis.step);
            EXPECT_NEAR(mark / axis.step, std::round(mark / axis.step), 1e-6);
        }
    }
}

TEST(Axis, OneValueGetsRoom) {
    const Axis axis = axis_for(5.0, 5.0, 6);
    EXPECT_LT(axis.low, 5.0);
    EXPECT_GT(axis.high, 5.0);
    EXPECT_EQ(axis_for(0.0, 10.0, 6).label(2.0), "2");
    EXPECT_EQ(axis_for(0.0, 0.5, 6).label(0.1), "0.1");
}

TEST(Draw, MakesSvgAndPng) {
    EXPECT_THAT(draw(some_plot(), Format::svg), HasSubstr("<svg"));
    const std::string png = draw(some_plot(), Format::png);
    EXPECT_THAT(png, StartsWith("\x89PNG"));
    EXPECT_GT(png.size(), 5'000U);
}

TEST(Draw, BearsWhatHasNoFiniteNumber) {
    Plot plot = some_plot();
    EXPECT_THAT(draw({"a", "A", "x", "y", true, {}}, Format::svg), HasSubstr("<svg"));
    plot.series = {{"nothing", PlotMark::line, {kNan, kNan}, {1.0, 2.0}, {}}};
    EXPECT_THAT(draw(plot, Format::svg), HasSubstr("<svg"));
    plot.series = {{"one", PlotMark::points, {1.0}, {2.0}, {0.5}}};
    plot.equal_axes = true;
    EXPECT_THAT(draw(plot, Format::svg), HasSubstr("<svg"));
}

TEST(Draw, BudgetBearsMeasurementsWithoutUncertainty) {
    EXPECT_THAT(draw_budget({}, Format::svg), HasSubstr("<svg"));
    EXPECT_THAT(
        draw_budget(
            {{"g", 9.81, 0.0, "m/s²", {}}, {"T", 2.0, 0.1, "s", {{"clock", 0.1}}}}, Format::png
        ),
        StartsWith("\x89PNG")
    );
}

TEST(Report, RoundsToTheUncertaintysTwoDigits) {
    EXPECT_EQ(with_uncertainty(9.810123, 0.00123), "9.8101 ± 0.0012");
    EXPECT_EQ(with_uncertainty(764.2, 15.3), "764 ± 15");
    EXPECT_EQ(with_uncertainty(-0.5, 0.25), "-0.50 ± 0.25");
    EXPECT_EQ(with_uncertainty(1.0, 0.0), "1");
    EXPECT_THAT(with_uncertainty(123456.0, 5000.0), HasSubstr("e5"));
}

TEST(Report, EscapesEveryText) {
    const nlohmann::json definition = {{"parameters", {{{"name", "length_m"}, {"unit", "<b>m"}}}}};
    const nlohmann::json result = {
        {"parameters", {{"length_m", 1.0}}},
        {"warnings", {"<script>alert(1)</script>"}},
        {"acceptance", {{{"fact", "<i>"}, {"ok", false}, {"reason", "<u>"}, {"min", 1}}}},
        {"accepted", false},
        {"results", {{{"name", "<g>"}, {"value", 9.8}, {"u", 0.1}, {"unit", "m/s²"}}}}};
    const std::string html =
        report_html({"<title>", "<heading>", definition, result, nlohmann::json::array()});
    for (const char* raw : {"<script", "<i>", "<u>", "<b>", "<g>", "<heading>"})
        EXPECT_THAT(html, Not(HasSubstr(raw)));
    EXPECT_THAT(html, HasSubstr("misses what a good one needs"));
}

TEST(PlotJson, NullIsAGap) {
    const auto plot = plot_from_json(nlohmann::json::parse(
        R"({"name":"a","series":[{"name":"s","mark":"points","x":[1,null,3],"y":[1,2]}]})"
    ));
    ASSERT_EQ(plot.series.size(), 1U);
    EXPECT_EQ(plot.series[0].x.size(), 2U);
    EXPECT_TRUE(std::isnan(plot.series[0].x[1]));
    EXPECT_EQ(plot.series[0].mark, PlotMark::points);
}

}  // namespace
}  // namespace kinectlab::plots
