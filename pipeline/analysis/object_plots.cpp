#include "pipeline/analysis/object_plots.hpp"

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
         {"fit", PlotMark::line, t, along(fit.fit_lab, origin, direction), {}}}};
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
         {"fit",
          PlotMark::line,
          along(fit.fit_lab, origin, right),
          along(fit.fit_lab, origin, up),
          {}}}};
}

Plot phase_plot(
    const ObjectFit& fit,
    const Trajectory& trajectory,
    const Vector3d& origin,
    const Vector3d& direction,
    const std::string& symbol
) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto x = along(fit.fit_lab, origin, direction);
    std::vector<double> v(x.size(), kNan);
    for (std::size_t i = 1; i + 1 < x.size(); ++i)
        v[i] = (x[i + 1] - x[i - 1]) / to_seconds(fit.t[i + 1] - fit.t[i - 1]);
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
        {std::move(measured), {"fit", PlotMark::line, x, std::move(v), {}}}};
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
