#include "pipeline/analysis/object_plots.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

ObjectFit swing_without_frames(int first, int last) {
    ObjectFit fit;
    for (int i = 0; i < 60; ++i) {
        if (i >= first && i <= last) continue;
        fit.t.push_back(i * kNsPerSecond / 30);
        const Eigen::Vector3d p(0.1 * std::sin(0.2 * i), 0.0, 1.0);
        fit.p_lab.push_back(p);
        fit.fit_lab.push_back(p);
        fit.residual.push_back(Eigen::Vector3d::Zero());
    }
    return fit;
}

int breaks_of(const PlotSeries& line) {
    int breaks = 0;
    for (std::size_t i = 1; i + 1 < line.y.size(); ++i)
        breaks += std::isnan(line.y[i]) && !std::isnan(line.y[i - 1]) ? 1 : 0;
    return breaks;
}

int breaks_of_position(const ObjectFit& fit) {
    const Plot plot =
        position_plot(fit, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), "x", "x", "x");
    EXPECT_EQ(plot.series.at(1).x.size(), plot.series[1].y.size());
    return breaks_of(plot.series[1]);
}

TEST(ObjectPlots, TheFitsLineBreaksWhereNothingWasSeen) {
    EXPECT_EQ(breaks_of_position(swing_without_frames(60, 60)), 0);
    EXPECT_EQ(breaks_of_position(swing_without_frames(20, 20)), 0) << "one frame is no gap";
    EXPECT_EQ(breaks_of_position(swing_without_frames(20, 40)), 1);
}

TEST(ObjectPlots, ThePhasePortraitHasNoChordOverAGap) {
    const auto fit = swing_without_frames(20, 40);
    const Plot plot = phase_plot(fit, {}, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), "x");
    const PlotSeries& line = plot.series.at(1);
    EXPECT_EQ(breaks_of(line), 1);
    for (const double v : line.y)  // of which some are no number
        EXPECT_FALSE(std::abs(v) > 0.1 * 0.2 * 30.0 * 1.01);
}

}  // namespace
}  // namespace kinectlab
