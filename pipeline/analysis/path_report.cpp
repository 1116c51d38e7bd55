#include "pipeline/analysis/path_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace kinectlab {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFrame = 0.12;  // s, not worth a word

double gap_share(std::span<const PositionSample> samples, const Stretch& stretch) {
    const auto frames =
        static_cast<double>(samples[stretch.end - 1].index - samples[stretch.begin].index + 1);
    return 1.0 - static_cast<double>(stretch.size()) / frames;
}

void replace(std::string& label, const std::string& metre, const std::string& pixel) {
    if (const auto at = label.find(metre); at != std::string::npos)
        label.replace(at, metre.size(), pixel);
}

}  // namespace

ObjectFit path_for_plots(
    const Trajectory& trajectory,
    std::span<const PositionSample> samples,
    const Stretch& stretch,
    const PathModel& model,
    const PathFit& fit
) {
    ObjectFit plot;
    plot.object = trajectory.object;
    const std::size_t first = samples[stretch.begin].index;
    const std::size_t last = samples[stretch.end - 1].index;
    std::vector<double> times;
    for (std::size_t i = first; i <= last; ++i)
        times.push_back(to_seconds(trajectory.samples[i].t - trajectory.samples.front().t));
    std::vector<Vector3d> path(times.size());
    model(fit.parameters, times, path);
    for (std::size_t i = 0; i < trajectory.samples.size(); ++i) {
        const MotionSample& sample = trajectory.samples[i];
        const bool inside = i >= first && i <= last;
        const bool tracked = sample.status == TrackStatus::tracked;
        plot.t.push_back(sample.t);
        plot.p_lab.push_back(tracked ? sample.p_lab : Vector3d::Constant(kNan));
        plot.fit_lab.push_back(inside ? path[i - first] : Vector3d::Constant(kNan));
        plot.residual.emplace_back(plot.p_lab.back() - plot.fit_lab.back());
    }
    plot.outliers = fit.outliers;
    plot.used = static_cast<int>(fit.used.size()) - fit.outliers;
    plot.reduced_chi2 = fit.reduced_chi2;
    return plot;
}

std::map<std::string, double> stretch_facts(
    std::span<const PositionSample> samples, const Stretch& stretch
) {
    return {
        {"duration_s", samples[stretch.end - 1].t - samples[stretch.begin].t},
        {"start_s", samples[stretch.begin].t},
        {"gap_share", gap_share(samples, stretch)}};
}

std::vector<std::string> stretch_warnings(
    std::span<const PositionSample> samples,
    const Stretch& stretch,
    const PathFit& fit,
    const std::string& motion,
    bool metric
) {
    std::vector<std::string> warnings;
    const double before = samples[stretch.begin].t - samples.front().t;
    const double after = samples.back().t - samples[stretch.end - 1].t;
    if (before > kFrame)
        warnings.push_back(
            fmt::format("The first {:.1f} s were not {} and were left out.", before, motion)
        );
    if (after > kFrame)
        warnings.push_back(
            fmt::format("The last {:.1f} s were not {} and were left out.", after, motion)
        );
    if (const double missing = gap_share(samples, stretch); missing > 0.2)
        warnings.push_back(fmt::format(
            "The object was not seen in {:.0f} % of the frames of the motion.", missing * 100.0
        ));
    if (static_cast<double>(fit.outliers) > 0.05 * static_cast<double>(fit.used.size()))
        warnings.push_back(fmt::format(
            "{} of {} positions lie far off the path and were left out; was something else in the "
            "picture?",
            fit.outliers,
            fit.used.size()
        ));
    if (metric && fit.reduced_chi2 > 2.5)
        warnings.push_back(fmt::format(
            "The positions scatter {:.1f} times as much about the fit as the tracker expects "
            "(reduced chi² {:.1f}); the uncertainties take this in, but look at the residuals.",
            std::sqrt(fit.reduced_chi2),
            fit.reduced_chi2
        ));
    return warnings;
}

Plot velocity_plot(const ObjectFit& fit, const Trajectory& trajectory, const Vector3d& direction) {
    const bool along = direction.norm() > 0.0;
    const auto size = [&](const Vector3d& v) {
        return along ? v.dot(direction) : v.norm();
    };
    PlotSeries measured{"measured", PlotMark::points, {}, {}, {}};
    PlotSeries fitted{"fit", PlotMark::line, {}, {}, {}};
    for (std::size_t i = 0; i < fit.t.size(); ++i) {
        const double t = to_seconds(fit.t[i] - fit.t.front());
        if (const auto& s = trajectory.samples[i]; s.status == TrackStatus::tracked) {
            measured.x.push_back(t);
            measured.y.push_back(size(s.v_lab));
        }
        double v = kNan;
        if (i > 0 && i + 1 < fit.t.size())
            v = size(
                (fit.fit_lab[i + 1] - fit.fit_lab[i - 1]) / to_seconds(fit.t[i + 1] - fit.t[i - 1])
            );
        fitted.x.push_back(t);
        fitted.y.push_back(v);
    }
    return {
        "velocity",
        along ? "Velocity against time" : "Speed against time",
        "t / s",
        "v / (m/s)",
        false,
        {std::move(measured), std::move(fitted)}};
}

void label_in_pixels(std::vector<Plot>& plots) {
    for (auto& plot : plots) {
        if (plot.y_label.find("/ mm") != std::string::npos)
            for (auto& series : plot.series)
                for (double& y : series.y)
                    y *= 1e-3;
        replace(plot.y_label, "/ mm", "/ px");
        for (std::string* label : {&plot.x_label, &plot.y_label}) {
            replace(*label, "(m/s)", "(px/s)");
            if (label->ends_with("/ m")) replace(*label, "/ m", "/ px");
        }
    }
}

double extent_of(std::span<const PositionSample> samples) {
    double largest = 0.0;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> x;
        for (const auto& s : samples)
            x.push_back(s.p_lab[k]);
        std::sort(x.begin(), x.end());
        const std::size_t cut = x.size() / 20;
        largest = std::max(largest, x[x.size() - 1 - cut] - x[cut]);
    }
    return largest;
}

}  // namespace kinectlab
