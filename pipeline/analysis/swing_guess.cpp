#include "pipeline/analysis/swing_guess.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>
#include <fmt/format.h>

namespace kinectlab {
namespace {

using std::numbers::pi;
using Plane = Eigen::Matrix<double, Eigen::Dynamic, 2>;  // x and y over time

constexpr double kSpectrumSpan = 60.0;   // s: longer records are looked at piece by piece
constexpr double kStrongestPull = 60.0;  // m/s²: no search for periods beyond
constexpr double kFewestPeriods = 3.0;
constexpr double kWidest = 0.985;  // sin 80°

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Eigen::Vector2d median_place(std::span<const SwingSample> samples) {
    std::vector<double> x, y;
    for (const auto& s : samples) {
        x.push_back(s.p_lab.x());
        y.push_back(s.p_lab.y());
    }
    return {median(std::move(x)), median(std::move(y))};
}

/// x and y about their middle, with wild values pulled in.
Plane clipped(std::span<const SwingSample> samples) {
    const Eigen::Vector2d middle = median_place(samples);
    std::vector<double> distance;
    for (const auto& s : samples)
        distance.push_back((s.p_lab.head<2>() - middle).norm());
    const double limit = 3.0 * median(std::move(distance));
    Plane xy(samples.size(), 2);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector2d d = samples[i].p_lab.head<2>() - middle;
        xy.row(static_cast<Eigen::Index>(i)) =
            (d.norm() > limit ? d * (limit / d.norm()) : d).transpose();
    }
    return xy;
}

/// How much of the variance of xy a sine of frequency f with a free mean explains.
double explained(std::span<const SwingSample> samples, const Plane& xy, double f) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double phase = 2.0 * pi * f * (samples[i].t - samples.front().t);
        const Eigen::Vector3d basis(1.0, std::cos(phase), std::sin(phase));
        normal += basis * basis.transpose();
        right += basis * xy.row(static_cast<Eigen::Index>(i));
    }
    return (right.array() * normal.ldlt().solve(right).array()).sum() -
           xy.colwise().sum().squaredNorm() / static_cast<double>(samples.size());
}

/// The minute that moves most.
std::span<const SwingSample> liveliest(std::span<const SwingSample> samples) {
    std::span<const SwingSample> best = samples;
    double most = -1.0;
    if (samples.back().t - samples.front().t <= kSpectrumSpan) return samples;
    std::size_t begin = 0;
    for (std::size_t end = 0; end <= samples.size(); ++end) {
        if (end < samples.size() && samples[end].t - samples[begin].t < kSpectrumSpan) continue;
        const auto piece = samples.subspan(begin, end - begin);
        const double spread = piece.size() < 30 ? 0.0 : clipped(piece).squaredNorm();
        if (spread > most) {
            most = spread;
            best = piece;
        }
        begin = end;
    }
    return best;
}

std::optional<double> find_frequency(std::span<const SwingSample> samples, double length_m) {
    const Plane xy = clipped(samples);
    const double total = (xy.rowwise() - xy.colwise().mean()).squaredNorm();
    if (!(total > 0.0)) return std::nullopt;
    const double span = samples.back().t - samples.front().t;
    const double highest = std::min(
        std::sqrt(kStrongestPull / length_m) / (2.0 * pi),
        0.45 * static_cast<double>(samples.size()) / span
    );
    const double step = 0.2 / span;
    double best = 0.0;
    double best_speed = -1.0;
    for (double f = 0.5 / span; f <= highest; f += step) {
        const double speed = explained(samples, xy, f) * f * f;
        if (speed > best_speed) {
            best_speed = speed;
            best = f;
        }
    }
    if (best == 0.0) return std::nullopt;
    double low = std::max(best - 2.0 * step, 0.1 / span);
    double high = best + 2.0 * step;
    for (int i = 0; i < 20; ++i) {  // golden section on the peak
        const double a = high - 0.618034 * (high - low);
        const double b = low + 0.618034 * (high - low);
        if (explained(samples, xy, a) > explained(samples, xy, b))
            high = b;
        else
            low = a;
    }
    best = (low + high) / 2.0;
    const double share = explained(samples, xy, best);
    const double noise = (total - share) / static_cast<double>(samples.size());
    if (share < 60.0 * noise)
        return std::nullopt;  // the best of a few hundred peaks of pure noise: 20
    return best;
}

struct Sine {
    double misfit = 0.0;                      // root mean square over amplitude
    double widest = 0.0;                      // farthest point from the middle, m
    Eigen::Vector2d middle, place, velocity;  // the last two at the first sample
};

/// A sine whose amplitude and phase drift, fitted with wild samples weighted down.
Sine fit_sine(std::span<const SwingSample> samples, double f) {
    const auto n = static_cast<Eigen::Index>(samples.size());
    const double half = (samples.back().t - samples.front().t) / 2.0;
    Eigen::Matrix<double, Eigen::Dynamic, 5> basis(n, 5);
    Plane xy(n, 2);
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
    for (int round = 0; round < 8; ++round) {
        const Eigen::Matrix<double, Eigen::Dynamic, 5> weighted = basis.array().colwise() * weight;
        c = (weighted.transpose() * basis).ldlt().solve(weighted.transpose() * xy);
        miss = (xy - basis * c).rowwise().norm().array();
        const double typical = std::max(median({miss.begin(), miss.end()}), 1e-9);
        weight = (2.0 * typical / miss.max(1e-12)).min(1.0);
    }
    Sine sine;
    const double w = 2.0 * pi * f;
    sine.middle = c.row(0);
    sine.place = c.row(1) - c.row(3);
    sine.velocity = w * (c.row(2) - c.row(4)) + c.row(3) / half;
    const double amplitude = std::sqrt(c.middleRows<2>(1).squaredNorm());
    sine.misfit = median({miss.begin(), miss.end()}) / std::max(amplitude, 1e-12);
    const Plane model = (basis.rightCols<4>() * c.bottomRows<4>());
    sine.widest = model.rowwise().norm().maxCoeff();
    return sine;
}

SwingParameters to_parameters(
    std::span<const SwingSample> samples, const Sine& sine, double length_m, double f
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

}  // namespace

Result<SwingGuess> guess_swing(std::span<const SwingSample> samples, double length_m) {
    const auto f = find_frequency(liveliest(samples), length_m);
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

    SwingGuess guess;
    guess.period = 1.0 / *f;
    Sine best;
    best.misfit = 1e9;
    std::size_t begin = 0;
    std::size_t end = 0;
    for (double start = samples.front().t; start + kFewestPeriods / *f <= samples.back().t + 1e-9;
         start += 0.5 / *f) {
        while (samples[begin].t < start)
            ++begin;
        while (end < samples.size() && samples[end].t <= start + kFewestPeriods / *f)
            ++end;
        if (end - begin < 12) continue;
        const Sine sine = fit_sine(samples.subspan(begin, end - begin), *f);
        if (sine.misfit >= best.misfit) continue;
        best = sine;
        guess.begin = begin;
        guess.end = end;
    }
    if (best.misfit > 0.5)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "no three periods of a free swing were found in the motion",
            "let the pendulum swing freely, without touching it, for at least three periods"
        );
    if (best.widest > kWidest * length_m)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format(
                "the bob moves {:.3f} m to the side on a length of {:.3f} m: an amplitude beyond "
                "80°",
                best.widest,
                length_m
            ),
            "release it from a smaller angle, or correct length_m"
        );
    guess.parameters =
        to_parameters(samples.subspan(guess.begin, guess.end - guess.begin), best, length_m, *f);
    return guess;
}

}  // namespace kinectlab
