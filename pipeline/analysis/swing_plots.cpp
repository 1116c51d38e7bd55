#include "pipeline/analysis/swing_plots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/swing_measurements.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kDegree = pi / 180.0;

/// The used samples' place and residual along the swing, s since the free swing began.
struct AlongSwing {
    std::vector<double> t, x, off;
    double sigma = 0.0;  ///< of one residual, m
};

AlongSwing along_swing(const FollowedSwing& swing, const SwingAxes& axes) {
    AlongSwing all;
    const auto& fit = swing.fit;
    double squares = 0.0;
    for (std::size_t i = fit.begin; i < fit.end; ++i) {
        if (!fit.used[i - fit.begin]) continue;
        const Vector3d& residual = fit.residuals[i - fit.begin];
        all.t.push_back(swing.samples[i].t - swing.samples[fit.begin].t);
        all.off.push_back(residual.dot(axes.along));
        all.x.push_back((swing.samples[i].p_lab - residual - axes.centre).dot(axes.along));
        squares += all.off.back() * all.off.back();
    }
    all.sigma = std::sqrt(squares / std::max<double>(1.0, static_cast<double>(all.t.size())));
    return all;
}

double small_period(const FollowedSwing& swing) {
    return 2.0 * pi / std::sqrt(swing.fit.parameters.omega0_sq);
}

struct Passage {
    double t = 0.0;
    double u = 0.0;
};

/// When the bob passed the middle: the fit's time, moved by what the positions around it say.
std::vector<Passage> passages(
    const FollowedSwing& swing, const SwingAxes& axes, const AlongSwing& all
) {
    const double quarter = small_period(swing) / 4.0;
    SwingPath path(swing.fit.parameters);
    const auto place = [&](double t) {
        path.go_to(t);
        return (path.position() - axes.centre).dot(axes.along);
    };
    const auto speed = [&](double t) {
        path.go_to(t);
        return swing.fit.parameters.radius * path.now().v.dot(axes.along);
    };
    std::vector<Passage> found;
    double before = place(0.0);
    std::size_t first = 0;
    for (double t = quarter / 2.0; t < swing.duration_s; t += quarter / 2.0) {
        const double here = place(t);
        const bool passed = (before < 0.0) != (here < 0.0);
        double at = t - quarter / 2.0 * here / (here - before);
        before = here;
        if (!passed) continue;
        for (int i = 0; i < 3; ++i)
            at -= place(at) / speed(at);
        while (first < all.t.size() && all.t[first] < at - quarter)
            ++first;
        double late = 0.0;
        double weight = 0.0;
        for (std::size_t i = first; i < all.t.size() && all.t[i] < at + quarter; ++i) {
            const double v = speed(all.t[i]);
            late -= all.off[i] * v;
            weight += v * v;
        }
        const double full = std::pow(speed(at), 2);
        const bool seen = weight > 2.0 * full;  // a few samples at least
        found.push_back(
            seen ? Passage{at + late / weight, all.sigma / std::sqrt(weight)} : Passage{at, 0.0}
        );
        place(t);
    }
    return found;
}

}  // namespace

SwingAxes swing_axes(const FollowedSwing& swing) {
    SwingAxes axes;
    const SwingParameters& p = swing.fit.parameters;
    axes.centre = p.pivot + p.radius * p.down();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const auto& point : swing.object.fit_lab)
        if (point.allFinite()) {
            const Eigen::Vector2d d = (point - axes.centre).head<2>();
            spread += d * d.transpose();
        }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(spread);
    Eigen::Vector2d main = eigen.eigenvectors().col(1);
    if (main.cwiseAbs().maxCoeff() == -main.minCoeff()) main = -main;  // points along +x or +y
    axes.along = {main.x(), main.y(), 0.0};
    axes.across = Vector3d::UnitZ().cross(axes.along);
    return axes;
}

Plot amplitude_plot(const FollowedSwing& swing, const SwingAxes& axes) {
    const AlongSwing all = along_swing(swing, axes);
    const double half = small_period(swing) / 2.0;
    PlotSeries measured{"measured in each half swing", PlotMark::points, {}, {}, {}};
    PlotSeries envelope{"fit", PlotMark::line, {}, {}, {}};
    std::size_t i = 0;
    for (double start = 0.0; start + half <= swing.duration_s; start += half) {
        const double fitted = amplitude_after(swing.fit.parameters, start + half / 2.0) / kDegree;
        envelope.x.push_back(start + half / 2.0);
        envelope.y.push_back(fitted);
        double more = 0.0;
        double weight = 0.0;
        for (; i < all.t.size() && all.t[i] < start + half; ++i) {
            more += all.off[i] * all.x[i];
            weight += all.x[i] * all.x[i];
        }
        const double reach = swing.fit.parameters.radius * std::sin(fitted * kDegree);
        if (!(weight > reach * reach)) continue;  // hardly seen
        measured.x.push_back(start + half / 2.0);
        measured.y.push_back(fitted * (1.0 + more / weight));
        measured.u.push_back(fitted * all.sigma / std::sqrt(weight));
    }
    return {
        "amplitude",
        "Amplitude over time",
        "t / s",
        "amplitude / °",
        false,
        {std::move(measured), std::move(envelope)}};
}

Plot period_amplitude_plot(const FollowedSwing& swing, const SwingAxes& axes) {
    const SwingParameters& p = swing.fit.parameters;
    const auto passed = passages(swing, axes, along_swing(swing, axes));
    const double t0 = small_period(swing);
    PlotSeries measured{"measured, each swing", PlotMark::points, {}, {}, {}};
    for (std::size_t i = 2; i < passed.size(); ++i) {
        if (passed[i].u == 0.0 || passed[i - 2].u == 0.0) continue;
        measured.x.push_back(amplitude_after(p, (passed[i].t + passed[i - 2].t) / 2.0) / kDegree);
        measured.y.push_back(passed[i].t - passed[i - 2].t);
        measured.u.push_back(std::hypot(passed[i].u, passed[i - 2].u));
    }
    PlotSeries exact{"T₀ (2/π) K(sin θ/2)", PlotMark::line, {}, {}, {}};
    PlotSeries series{"T₀ (1 + θ²/16 + 11θ⁴/3072 + 173θ⁶/737280)", PlotMark::line, {}, {}, {}};
    const double widest = 1.1 * energy_angle(p);
    constexpr int kPoints = 40;
    for (int i = 0; i <= kPoints; ++i) {
        const double theta = widest * i / kPoints;
        const double s = theta * theta;
        exact.x.push_back(theta / kDegree);
        exact.y.push_back(t0 * period_factor(theta));
        series.x.push_back(theta / kDegree);
        series.y.push_back(
            t0 * (1.0 + s / 16.0 + 11.0 * s * s / 3072.0 + 173.0 * s * s * s / 737280.0)
        );
    }
    return {
        "period_amplitude",
        "Period against amplitude",
        "amplitude / °",
        "period / s",
        false,
        {std::move(measured), std::move(exact), std::move(series)}};
}

std::map<std::string, double> swing_facts(
    const FollowedSwing& swing, const std::vector<Measurement>& measurements
) {
    std::map<std::string, double> facts;
    for (const auto& m : measurements) {
        if (m.name == "period") facts["periods"] = swing.duration_s / m.value;
        if (m.name == "amplitude") facts["amplitude_deg"] = m.value / kDegree;
    }
    std::vector<double> steps;
    for (std::size_t i = swing.fit.begin + 1; i < swing.fit.end; ++i)
        steps.push_back(swing.samples[i].t - swing.samples[i - 1].t);
    const double step = median(steps);
    double missing = 0.0;
    for (const double s : steps)
        missing += std::max(0.0, std::round(s / step) - 1.0) * step;
    facts["gap_share"] = missing / swing.duration_s;
    return facts;
}

}  // namespace kinectlab
