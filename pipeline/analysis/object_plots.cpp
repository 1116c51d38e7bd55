#include "pipeline/analysis/object_plots.hpp"

#include <algorithm>
#include <limits>

#include "pipeline/core/time.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;

std::vector<double> seconds(const ObjectFit& fit) {
    std::vector<double> t;
    t.reserve(fit.t.size());
    for (const TimeNs at : fit.t)
        t.push_back(to_seconds(at - fit.t.front()));
    return t;
}

std::vector<double> along(
    const std::vector<Vector3d>& points, const Vector3d& origin, const Vector3d& direction
) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const auto& p : points)
        values.push_back((p - origin).dot(direction));
    return values;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Longer than any pause between neighbouring samples, s: beyond it the fit's own line would be a
/// chord that it never took.
double longest_step(const ObjectFit& fit) {
    constexpr double kFrames = 2.5;
    std::vector<double> steps;
    for (std::size_t i = 1; i < fit.t.size(); ++i)
        steps.push_back(to_seconds(fit.t[i] - fit.t[i - 1]));
    if (steps.empty()) return 0.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return kFrames * *middle;
}

/// The fit as a line that breaks where nothing was seen.
PlotSeries fit_line(
    const ObjectFit& fit, const std::vector<double>& x, const std::vector<double>& y
) {
    const double longest = longest_step(fit);
    PlotSeries line{"fit", PlotMark::line, {}, {}, {}};
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (i > 0 && to_seconds(fit.t[i] - fit.t[i - 1]) > longest) {
            line.x.push_back(x[i]);
            line.y.push_back(kNan);
        }
        line.x.push_back(x[i]);
        line.y.push_back(y[i]);
    }
    return line;
}

}  // namespace

Plot position_plot(
    const ObjectFit& fit,
    const Vector3d& origin,
    const Vector3d& direction,
    const std::string& name,
    const std::string& title,
    const std::string& symbol
) {
    const auto t = seconds(fit);
    return {
        name,
        title,
        "t / s",
        symbol + " / m",
        false,
        {{"measured", PlotMark::points, t, along(fit.p_lab, origin, direction), {}},
         fit_line(fit, t, along(fit.fit_lab, origin, direction))}};
}

Plot residual_plot(const ObjectFit& fit, const std::string& name) {
    const auto t = seconds(fit);
    Plot plot{name, "Residuals: measured minus fitted", "t / s", "residual / mm", false, {}};
    const char* axes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i)
        plot.series.push_back(
            {axes[i],
             PlotMark::points,
             t,
             along(fit.residual, Vector3d::Zero(), 1e3 * Vector3d::Unit(i)),
             {}}
        );
    return plot;
}

Plot path_plot(
    const ObjectFit& fit,
    const Vector3d& origin,
    const Vector3d& right,
    const Vector3d& up,
    const std::string& right_symbol,
    const std::string& up_symbol
) {
    return {
        "path",
        "Path",
        right_symbol + " / m",
        up_symbol + " / m",
        true,
        {{"measured",
          PlotMark::points,
          along(fit.p_lab, origin, right),
          along(fit.p_lab, origin, up),
          {}},
         fit_line(fit, along(fit.fit_lab, origin, right), along(fit.fit_lab, origin, up))}};
}

Plot phase_plot(
    const ObjectFit& fit,
    const Trajectory& trajectory,
    const Vector3d& origin,
    const Vector3d& direction,
    const std::string& symbol
) {
    const double longest = longest_step(fit);
    const auto x = along(fit.fit_lab, origin, direction);
    std::vector<double> v(x.size(), kNan);
    for (std::size_t i = 1; i + 1 < x.size(); ++i)
        if (const double dt = to_seconds(fit.t[i + 1] - fit.t[i - 1]); dt <= longest)
            v[i] = (x[i + 1] - x[i - 1]) / dt;
    PlotSeries measured{"measured", PlotMark::points, {}, {}, {}};
    for (const auto& sample : trajectory.samples) {
        if (sample.status != TrackStatus::tracked) continue;
        measured.x.push_back((sample.p_lab - origin).dot(direction));
        measured.y.push_back(sample.v_lab.dot(direction));
    }
    return {
        "phase",
        "Phase portrait",
        symbol + " / m",
        "v / (m/s)",
        false,
        {std::move(measured), fit_line(fit, x, v)}};
}

void label_pixels(std::vector<Plot>& plots) {
    const auto relabel = [](std::string& label) {
        for (const auto& [unit, instead] :
             {std::pair(" / mm", " / px"),
              std::pair(" / (m/s)", " / (1000 px/s)"),
              std::pair(" / m", " / 1000 px")}) {
            if (!label.ends_with(unit)) continue;
            label.replace(label.size() - std::string_view(unit).size(), std::string::npos, instead);
            return;
        }
    };
    for (auto& plot : plots) {
        relabel(plot.x_label);
        relabel(plot.y_label);
    }
}

}  // namespace kinectlab
