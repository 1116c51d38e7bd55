#include "pipeline/analysis/swing_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

using std::numbers::pi;

constexpr double kSpan = 60.0;           // s
constexpr double kStrongestPull = 60.0;  // m/s²: no search for shorter periods than it would cause
constexpr std::size_t kFewestSamples = 30;
constexpr double kClearPeak =
    60.0;  // times the noise; the best of a few hundred peaks of noise: 20

/// x and y about their middle, weighted, with wild values pulled in.
PlanePath clipped(std::span<const PositionSample> samples) {
    std::vector<double> x, y, distance;
    for (const auto& s : samples) {
        x.push_back(s.p_lab.x());
        y.push_back(s.p_lab.y());
    }
    const Eigen::Vector2d middle(median(std::move(x)), median(std::move(y)));
    const Eigen::Vector2d weights = axis_weights(samples);
    PlanePath xy(samples.size(), 2);
    Eigen::Index i = 0;
    for (const auto& s : samples) {
        const Eigen::Vector2d d = weights.cwiseProduct(s.p_lab.head<2>() - middle);
        distance.push_back(d.norm());
        xy.row(i++) = d.transpose();
    }
    const double limit = 3.0 * median(std::move(distance));
    for (auto row : xy.rowwise())
        if (const double d = row.norm(); d > limit) row *= limit / d;
    return xy;
}

/// How much of the sum of squares about the mean a sine of frequency f explains.
double explained(std::span<const PositionSample> samples, const PlanePath& xy, double f) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    Eigen::Index i = 0;
    for (const auto& s : samples) {
        const double phase = 2.0 * pi * f * (s.t - samples.front().t);
        const Eigen::Vector3d basis(1.0, std::cos(phase), std::sin(phase));
        normal += basis * basis.transpose();
        right += basis * xy.row(i++);
    }
    return (right.array() * normal.ldlt().solve(right).array()).sum() -
           xy.colwise().sum().squaredNorm() / static_cast<double>(samples.size());
}

std::span<const PositionSample> liveliest(std::span<const PositionSample> samples) {
    if (samples.back().t - samples.front().t <= kSpan) return samples;
    std::span<const PositionSample> best = samples;
    double most = -1.0;
    std::size_t begin = 0;
    for (std::size_t end = 1; end <= samples.size(); ++end) {
        if (end < samples.size() && samples[end].t - samples[begin].t < kSpan) continue;
        const auto piece = samples.subspan(begin, end - begin);
        const double moves = piece.size() < 30 ? 0.0 : clipped(piece).squaredNorm();
        if (moves > most) {
            most = moves;
            best = piece;
        }
        begin = end;
    }
    return best;
}

template <class F>
double golden_section_maximum(F f, double low, double high) {
    constexpr double kRatio = 0.6180339887498949;
    for (int i = 0; i < 20; ++i) {
        const double a = high - kRatio * (high - low);
        const double b = low + kRatio * (high - low);
        if (f(a) > f(b))
            high = b;
        else
            low = a;
    }
    return (low + high) / 2.0;
}

struct Peak {
    double f = 0.0;           // 1/s
    double over_noise = 0.0;  // its sum of squares, in those of the noise for each sample
};

Peak highest_peak(std::span<const PositionSample> samples, double length_m) {
    const PlanePath xy = clipped(samples);
    const double total = (xy.rowwise() - xy.colwise().mean()).squaredNorm();
    const double span = samples.back().t - samples.front().t;
    const auto n = static_cast<double>(samples.size());
    const double highest =
        std::min(std::sqrt(kStrongestPull / length_m) / (2.0 * pi), 0.45 * n / span);
    const double step = 0.25 / span;
    double best = 0.0;
    double best_speed = 0.0;
    for (double f = 0.5 / span; f <= highest; f += step) {
        const double speed = explained(samples, xy, f) * f * f;
        if (speed <= best_speed) continue;
        best_speed = speed;
        best = f;
    }
    if (best == 0.0) return {};
    const auto peak = [&](double f) {
        return explained(samples, xy, f);
    };
    best = golden_section_maximum(peak, std::max(best - 2.0 * step, 0.1 / span), best + 2.0 * step);
    const double noise = (total - peak(best)) / n;
    return {best, peak(best) / std::max(noise, 1e-30)};
}

}  // namespace

Eigen::Vector2d axis_weights(std::span<const PositionSample> samples) {
    std::vector<double> x, y;
    for (const auto& s : samples) {
        x.push_back(s.sigma.x());
        y.push_back(s.sigma.y());
    }
    const Eigen::Vector2d sigma(median(std::move(x)), median(std::move(y)));
    return sigma.cwiseInverse() * sigma.minCoeff();
}

std::optional<double> find_frequency(std::span<const PositionSample> all, double length_m) {
    const auto samples = liveliest(all);
    // Bringing the bob to its place can be a larger motion than the swing; a part is free of it.
    for (const std::size_t parts : {1, 2, 4}) {
        const std::size_t size = samples.size() / parts;
        if (size < kFewestSamples) break;
        Peak best;
        for (std::size_t begin = 0; begin + size <= samples.size(); begin += (size + 1) / 2) {
            const Peak peak = highest_peak(samples.subspan(begin, size), length_m);
            if (peak.over_noise > best.over_noise) best = peak;
        }
        if (best.over_noise >= kClearPeak) return best.f;
    }
    return std::nullopt;
}

}  // namespace kinectlab
