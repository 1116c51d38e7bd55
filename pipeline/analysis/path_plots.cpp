#include "pipeline/analysis/path_plots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinectlab {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTicks = 40.0;      // along the map
constexpr double kTickShare = 0.04;  // of the map's size

Plot map(const SmoothPath& path, const ObjectFit& fit, const PathNumbers& numbers, bool metric) {
    PlotSeries measured{"measured", PlotMark::points, {}, {}, {}};
    for (const auto& p : fit.p_lab) {
        measured.x.push_back(p.x());
        measured.y.push_back(p.y());
    }
    PlotSeries smooth{"smoothed", PlotMark::line, {}, {}, {}};
    PlotSeries ticks{"heading", PlotMark::line, {}, {}, {}};
    Eigen::Vector2d low = path.points.front().value.head<2>();
    Eigen::Vector2d high = low;
    for (const auto& point : path.points) {
        low = low.cwiseMin(point.value.head<2>());
        high = high.cwiseMax(point.value.head<2>());
    }
    const double tick = kTickShare * (high - low).norm();
    const double every = numbers.length.value / kTicks;
    double way = every;
    std::size_t stretch = 0;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        if (i == path.stretch_ends[stretch]) {
            ++stretch;
            smooth.x.push_back(kNan);
            smooth.y.push_back(kNan);
        }
        const Eigen::Vector3d& p = path.points[i].value;
        smooth.x.push_back(p.x());
        smooth.y.push_back(p.y());
        if (i > 0) way += (p - path.points[i - 1].value).head<2>().norm();
        if (way < every || !std::isfinite(numbers.heading[i])) continue;
        way = 0.0;
        const double h = numbers.heading[i];
        ticks.x.insert(ticks.x.end(), {p.x(), p.x() + tick * std::cos(h), kNan});
        ticks.y.insert(ticks.y.end(), {p.y(), p.y() + tick * std::sin(h), kNan});
    }
    const std::string unit = metric ? "m" : "px";
    return {
        "map",
        "Path and headings from above",
        "x / " + unit,
        "y / " + unit,
        true,
        {std::move(measured), std::move(smooth), std::move(ticks)}};
}

}  // namespace

std::vector<Plot> path_plots(
    const SmoothPath& path, const ObjectFit& fit, const PathNumbers& numbers, bool metric
) {
    std::vector<double> t;
    for (const auto& s : path.samples)
        t.push_back(s.t);
    const auto against_time = [&](const char* name,
                                  const char* title,
                                  const char* label,
                                  const std::vector<double>& y,
                                  const std::vector<double>& u) {
        return Plot{name, title, "t / s", label, false, {{"smoothed", PlotMark::line, t, y, u}}};
    };
    std::vector<Plot> plots{map(path, fit, numbers, metric)};
    if (metric)
        plots.push_back(
            against_time("speed", "Speed against time", "v / (m/s)", numbers.speed, numbers.speed_u)
        );
    plots.push_back(against_time(
        "turning",
        "Turning rate against time",
        "turning / (rad/s)",
        numbers.turning,
        numbers.turning_u
    ));
    plots.push_back(
        against_time("heading", "Heading against time", "heading / rad", numbers.heading, {})
    );
    return plots;
}

}  // namespace kinectlab
