#pragma once

#include <string>
#include <vector>

namespace kinectlab {

enum class PlotMark { line, points };

/// One curve. x and y are of one length; a NaN breaks a line and hides a point.
struct PlotSeries {
    std::string name;  ///< for the legend, e.g. "measured"
    PlotMark mark = PlotMark::line;
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> u;  ///< standard uncertainty of y for error bars; empty = none
};

/// A picture of numbers, free of how it is drawn: the page and the printed report show the same.
struct Plot {
    std::string name;  ///< by which a definition chooses it: "phase"
    std::string title;
    std::string x_label;      ///< with its unit: "t / s"
    std::string y_label;      ///< "x / m"
    bool equal_axes = false;  ///< a metre is as long to the right as upwards: paths, maps
    std::vector<PlotSeries> series;
};

}  // namespace kinectlab
