#include "pipeline/analysis/swing_guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/swing_arc.hpp"
#include "pipeline/analysis/swing_spectrum.hpp"

namespace kinectlab {
namespace {

using std::numbers::pi;
constexpr double kFewestPeriods = 3.0;
constexpr double kWidest = 0.985;  // sin 80°
constexpr double kShortest = 0.1;  // m: no search for the periods of shorter ones

struct Sine {
    double misfit = std::numeric_limits<double>::infinity();  // root mean square over amplitude
    double widest = 0.0;                                      // farthest point from the middle, m
    Eigen::Vector2d middle, place, velocity;                  // the last two at the first sample
};

/// A sine whose amplitude and phase drift, fitted with wild samples weighted down.
Sine fit_sine(std::span<const PositionSample> samples, double f, const Eigen::Vector2d& weights) {
    const auto n = static_cast<Eigen::Index>(samples.size());
    const double half = (samples.back().t - samples.front().t) / 2.0;
    Eigen::Matrix<double, Eigen::Dynamic, 5> basis(n, 5);
    PlanePath xy(n, 2);
    for (Eigen::Index i = 0; i < n; ++i) {
        const double t = samples[static_cast<std::size_t>(i)].t - samples.front().t;
        const double c = std::cos(2.0 * pi * f * t);
        const double s = std::sin(2.0 * pi * f * t);
        const double drift = (t - half) / half;
        basis.row(i) << 1.0, c, s, drift * c, drift * s;
        xy.row(i) = samples[static_cast<std::size_t>(i)].p_lab.head<2>().transpose();
    }
    Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(n);
    Eigen::Matrix<double, 5, 2> c;
    Eigen::ArrayXd miss;
    for (int round = 0; round < 5; ++round) {
        const Eigen::Matrix<double, Eigen::Dynamic, 5> weighted = basis.array().colwise() * weight;
        c = (weighted.transpose() * basis).ldlt().solve(weighted.transpose() * xy);
        miss = ((xy - basis * c) * weights.asDiagonal()).rowwise().norm().array();
        const double typical = std::max(median({miss.begin(), miss.end()}), 1e-9);
        weight = (2.0 * typical / miss.max(1e-12)).min(1.0);
    }
    Sine sine;
    const double w = 2.0 * pi * f;
    sine.middle = c.row(0);
    sine.place = c.row(1) - c.row(3);
    sine.velocity = w * (c.row(2) - c.row(4)) + c.row(3) / half;
    const double amplitude = (c.middleRows<2>(1) * weights.asDiagonal()).norm();
    sine.misfit = median({miss.begin(), miss.end()}) / std::max(amplitude, 1e-12);
    for (Eigen::Index i = 0; i < n; ++i)
        if (weight[i] > 0.4)  // not an outlier
            sine.widest = std::max(sine.widest, (xy.row(i) - c.row(0)).norm());
    return sine;
}

struct Window {
    Sine sine;
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// Of all windows of three periods, half a period apart, the one most like a sine.
Window best_window(std::span<const PositionSample> samples, double f) {
    const Eigen::Vector2d weights = axis_weights(samples);
    const double length_s = kFewestPeriods / f;
    Window best;
    std::size_t begin = 0;
    std::size_t end = 0;
    for (double start = samples.front().t; start + length_s <= samples.back().t + 1e-9;
         start += 0.5 / f) {
        while (samples[begin].t < start)
            ++begin;
        while (end < samples.size() && samples[end].t <= start + length_s)
            ++end;
        const bool seen_throughout =
            end - begin >= 12 && samples[end - 1].t - samples[begin].t >= 2.5 / f;
        if (!seen_throughout) continue;
        const Sine sine = fit_sine(samples.subspan(begin, end - begin), f, weights);
        if (sine.misfit < best.sine.misfit) best = {sine, begin, end};
    }
    return best;
}

SwingParameters to_parameters(
    std::span<const PositionSample> samples, const Sine& sine, double length_m, double f
) {
    SwingParameters p;
    p.radius = length_m;
    const auto height = [&](double across) {
        return std::sqrt(std::max(length_m * length_m - across * across, 0.03 * length_m * length_m)
        );
    };
    std::vector<double> pivot_z;
    for (const auto& s : samples)
        pivot_z.push_back(s.p_lab.z() + height((s.p_lab.head<2>() - sine.middle).norm()));
    p.pivot << sine.middle, median(std::move(pivot_z));
    p.n << sine.place, -height(sine.place.norm());
    p.n.normalize();
    p.v << sine.velocity / length_m, 0.0;
    p.v.z() = -p.v.head<2>().dot(p.n.head<2>()) / p.n.z();
    const double stretch = period_factor(std::asin(std::min(sine.widest / length_m, 0.98)));
    p.omega0_sq = std::pow(2.0 * pi * f * stretch, 2);
    return p;
}

/// From the arc where it shows, else from the weight of things on the Earth, else as if the swing
/// were small: a start for a fit that finds it better.
double rough_length(
    std::span<const PositionSample> samples, const Sine& sine, double f, bool metric
) {
    const ArcCurvature arc = arc_curvature(samples);
    const double least = sine.widest / 0.97;
    if (arc.shows()) return std::max(least, 0.5 / arc.value);
    if (metric) return std::max(least, 9.81 / std::pow(2.0 * pi * f, 2));
    return 8.0 * sine.widest;
}

}  // namespace

Result<SwingGuess> guess_swing(
    std::span<const PositionSample> samples, std::optional<double> given_length, bool metric
) {
    const auto f = find_frequency(samples, given_length.value_or(kShortest));
    if (!f)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "the object does not swing: its motion is not above the noise",
            "release the pendulum from a few degrees and record at least three periods"
        );
    const double span = samples.back().t - samples.front().t;
    if (span * *f < kFewestPeriods)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format(
                "the recording holds {:.1f} periods ({:.2f} s of a period of {:.2f} s)",
                span * *f,
                span,
                1.0 / *f
            ),
            "record at least three periods, ten or more for a good result"
        );

    const Window best = best_window(samples, *f);
    if (best.sine.misfit > 0.5)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "no three periods of a free swing below 80° were found in the motion",
            "let the pendulum swing freely, without touching it, for at least three periods"
        );
    const double length_m = given_length.value_or(rough_length(samples, best.sine, *f, metric));
    if (given_length && best.sine.widest > kWidest * length_m)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format(
                "the bob moves {:.3f} m to the side on a length of {:.3f} m: an amplitude beyond "
                "80°",
                best.sine.widest,
                length_m
            ),
            "release it from a smaller angle, or correct length_m"
        );
    const auto window = samples.subspan(best.begin, best.end - best.begin);
    return SwingGuess{
        best.begin, best.end, 1.0 / *f, to_parameters(window, best.sine, length_m, *f)};
}

}  // namespace kinectlab
