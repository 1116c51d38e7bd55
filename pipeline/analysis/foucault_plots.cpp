#include "pipeline/analysis/foucault_plots.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace kinectlab {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr double kPeriods = 5.0;  // in each point

struct Orbit {
    double t = 0.0;      ///< the middle, s since the first sample
    double angle = 0.0;  ///< of the main direction, rad
    double width = 0.0;  ///< half, signed, m
    double angle_u = 0.0, width_u = 0.0;
};

struct Orbits {
    std::vector<Orbit> measured, fitted;
};

/// The principal axis of some points about the centre.
double main_angle(const std::vector<Vector2d>& points, double before) {
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const auto& p : points)
        spread += p * p.transpose();
    const double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
    return angle + pi * std::round((before - angle) / pi);
}

Orbits orbits(const FollowedSwing& swing, const SwingAxes& axes) {
    const ObjectFit& fit = swing.object;
    const double omega = std::sqrt(swing.fit.parameters.omega0_sq);
    const double window = kPeriods * 2.0 * pi / omega;
    double squares = 0.0;
    double n = 0.0;
    for (const auto& r : swing.fit.residuals) {
        squares += std::pow(r.dot(axes.across), 2);
        n += 1.0;
    }
    const double sigma = std::sqrt(squares / n);
    Orbits all;
    double before = std::atan2(axes.along.y(), axes.along.x());
    std::vector<Vector2d> seen, model, velocity;
    double start = -1.0;
    for (std::size_t i = 1; i + 1 < fit.t.size(); ++i) {
        if (!fit.fit_lab[i - 1].allFinite() || !fit.fit_lab[i + 1].allFinite()) continue;
        const double t = to_seconds(fit.t[i] - fit.t.front());
        if (start < 0.0) start = t;
        if (t - start >= window) {
            if (static_cast<double>(seen.size()) > 20.0) {
                Orbit of_fit{start + window / 2.0, main_angle(model, before), 0.0, 0.0, 0.0};
                before = of_fit.angle;
                Orbit of_seen{of_fit.t, main_angle(seen, before), 0.0, 0.0, 0.0};
                const Vector2d along(std::cos(before), std::sin(before));
                const Vector2d across(-along.y(), along.x());
                double lag2 = 0.0, length2 = 0.0;
                for (std::size_t k = 0; k < seen.size(); ++k) {
                    const double lag = -velocity[k].dot(along) / omega;
                    of_seen.width += seen[k].dot(across) * lag;
                    of_fit.width += model[k].dot(across) * lag;
                    lag2 += lag * lag;
                    length2 += model[k].squaredNorm();
                }
                const double half_length =
                    std::sqrt(2.0 * length2 / static_cast<double>(seen.size()));
                of_seen.width *= half_length / lag2;
                of_fit.width *= half_length / lag2;
                of_seen.width_u = sigma * half_length / std::sqrt(lag2);
                of_seen.angle_u = sigma / std::sqrt(length2);
                all.measured.push_back(of_seen);
                all.fitted.push_back(of_fit);
            }
            seen.clear(), model.clear(), velocity.clear();
            start = t;
        }
        if (!fit.p_lab[i].allFinite()) continue;
        seen.push_back((fit.p_lab[i] - axes.centre).head<2>());
        model.push_back((fit.fit_lab[i] - axes.centre).head<2>());
        velocity.push_back(
            (fit.fit_lab[i + 1] - fit.fit_lab[i - 1]).head<2>() /
            to_seconds(fit.t[i + 1] - fit.t[i - 1])
        );
    }
    return all;
}

Plot plot_of(
    const Orbits& all,
    Plot plot,
    double (*value)(const Orbit&),
    double (*u)(const Orbit&),
    double zero
) {
    PlotSeries measured{"measured in five periods", PlotMark::points, {}, {}, {}};
    PlotSeries fitted{"fit", PlotMark::line, {}, {}, {}};
    for (const auto& orbit : all.measured) {
        measured.x.push_back(orbit.t);
        measured.y.push_back(value(orbit) - zero);
        measured.u.push_back(u(orbit));
    }
    for (const auto& orbit : all.fitted) {
        fitted.x.push_back(orbit.t);
        fitted.y.push_back(value(orbit) - zero);
    }
    plot.series = {std::move(measured), std::move(fitted)};
    return plot;
}

}  // namespace

Plot plane_angle_plot(const FollowedSwing& swing, const SwingAxes& axes) {
    const Orbits all = orbits(swing, axes);
    const auto degrees = [](const Orbit& o) {
        return o.angle * 180.0 / pi;
    };
    return plot_of(
        all,
        {"plane_angle", "Direction of the swing's plane", "t / s", "turned by / °", false, {}},
        degrees,
        [](const Orbit& o) { return o.angle_u * 180.0 / pi; },
        all.fitted.empty() ? 0.0 : degrees(all.fitted.front())
    );
}

Plot ellipse_plot(const FollowedSwing& swing, const SwingAxes& axes) {
    return plot_of(
        orbits(swing, axes),
        {"ellipse", "Half the orbit's width", "t / s", "b / mm", false, {}},
        [](const Orbit& o) { return o.width * 1e3; },
        [](const Orbit& o) { return o.width_u * 1e3; },
        0.0
    );
}

}  // namespace kinectlab
