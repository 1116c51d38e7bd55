#include "pipeline/analysis/path_stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

using Eigen::Array3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kFewest = 5;  // samples of a stretch
constexpr std::size_t kLongest = 500;
constexpr double kPrice = 100.0;       // of a stretch; noise that lasts for five frames earns 20
constexpr double kMedianChi2 = 2.366;  // of three degrees of freedom
constexpr double kFollows = 3.2;       // median distance of a block, in sigma: noise's own is 1.5
constexpr double kFits = 2.4;          // the same where the block is part of the fit
constexpr double kWild = 8.0;          // sigma
constexpr double kLasting = 3.0;       // how much lasting noise may widen an acceleration

/// Third difference of four neighbours, in units of its own noise.
double roughness(
    const PositionSample& a,
    const PositionSample& b,
    const PositionSample& c,
    const PositionSample& d
) {
    // Weights of the divided difference, so that uneven times do no harm.
    const double t[4] = {a.t, b.t, c.t, d.t};
    const Vector3d* p[4] = {&a.p_lab, &b.p_lab, &c.p_lab, &d.p_lab};
    Vector3d sum = Vector3d::Zero();
    double squares = 0.0;
    for (int i = 0; i < 4; ++i) {
        double w = 1.0;
        for (int k = 0; k < 4; ++k)
            if (k != i) w /= (t[i] - t[k]) / (d.t - a.t);
        sum += w * *p[i];
        squares += w * w;
    }
    return (b.whiten * sum).norm() / std::sqrt(squares);
}

/// Indices of the samples without single ones that lie off while their neighbours fit together.
std::vector<std::size_t> tame(std::span<const PositionSample> s, double excess) {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const bool inside = kept.size() >= 2 && i + 2 < s.size();
        if (inside) {
            const PositionSample& a = s[kept[kept.size() - 2]];
            const PositionSample& b = s[kept.back()];
            const bool without = roughness(a, b, s[i + 1], s[i + 2]) < kWild * excess;
            const bool with = roughness(a, b, s[i], s[i + 1]) < kWild * excess;
            if (without && !with) continue;
        }
        kept.push_back(i);
    }
    return kept;
}

/// Sums of one stretch about its first sample; the noise is that of each axis.
struct Sums {
    double t[5] = {};
    Matrix3d right = Matrix3d::Zero();  // rows 1, t, t²/2
    Array3d squares = Array3d::Zero();

    void add(double dt, const Vector3d& d) {
        double power = 1.0;
        for (double& sum : t) {
            sum += power;
            power *= dt;
        }
        right.row(0) += d.transpose();
        right.row(1) += dt * d.transpose();
        right.row(2) += dt * dt / 2.0 * d.transpose();
        squares += d.array().square();
    }
    [[nodiscard]] Matrix3d inverse() const {
        Matrix3d m;
        m << t[0], t[1], t[2] / 2, t[1], t[2], t[3] / 2, t[2] / 2, t[3] / 2, t[4] / 4;
        return m.inverse();
    }
    [[nodiscard]] double cost() const {
        const Matrix3d rows = inverse() * right;
        return (squares - rows.cwiseProduct(right).colwise().sum().transpose().array())
            .max(0.0)
            .sum();
    }
};

Vector3d axis_sigma(std::span<const PositionSample> samples, double excess) {
    Vector3d sigma;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> all;
        for (const auto& s : samples)
            all.push_back(s.sigma[k]);
        sigma[k] = excess * median(std::move(all));
    }
    return sigma;
}

double off_by_median(
    std::span<const PositionSample> samples, const std::vector<Vector3d>& path, double excess
) {
    std::vector<double> off;
    for (std::size_t i = 0; i < samples.size(); ++i)
        off.push_back((samples[i].whiten * (samples[i].p_lab - path[i])).norm() / excess);
    return median(std::move(off));
}

}  // namespace

double noise_excess(std::span<const PositionSample> samples) {
    std::vector<double> all;
    for (std::size_t i = 3; i < samples.size(); ++i)
        all.push_back(roughness(samples[i - 3], samples[i - 2], samples[i - 1], samples[i]));
    if (all.empty()) return 1.0;
    return std::max(median(std::move(all)) / std::sqrt(kMedianChi2), 1.0);
}

std::vector<ParabolaStretch> parabola_stretches(std::span<const PositionSample> all) {
    const double excess = noise_excess(all);
    const Vector3d sigma = axis_sigma(all, excess);
    const std::vector<std::size_t> kept = tame(all, excess);
    const std::size_t n = kept.size();
    const auto scaled = [&](std::size_t i, std::size_t origin) -> Vector3d {
        return (all[kept[i]].p_lab - all[kept[origin]].p_lab).cwiseQuotient(sigma);
    };
    std::vector<double> cost(n + 1, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> from(n + 1, 0);
    cost[0] = 0.0;
    for (std::size_t b = 0; b + kFewest <= n; ++b) {
        if (!std::isfinite(cost[b])) continue;
        Sums sums;
        for (std::size_t e = b; e < std::min(b + kLongest, n); ++e) {
            sums.add(all[kept[e]].t - all[kept[b]].t, scaled(e, b));
            if (e - b + 1 < kFewest) continue;
            const double here = sums.cost();
            if (cost[b] + here + kPrice < cost[e + 1]) {
                cost[e + 1] = cost[b] + here + kPrice;
                from[e + 1] = b;
            }
            // Sums only grow: far beyond every price there is nothing more to find.
            if (here > 40.0 * kPrice + 10.0 * static_cast<double>(e - b)) break;
        }
    }
    std::vector<ParabolaStretch> stretches;
    std::size_t end = n;
    while (end > 0 && !std::isfinite(cost[end]))
        --end;
    while (end > 0) {
        const std::size_t b = from[end];
        Sums sums;
        for (std::size_t i = b; i < end; ++i)
            sums.add(all[kept[i]].t - all[kept[b]].t, scaled(i, b));
        const Matrix3d inverse = sums.inverse();
        const Matrix3d rows = inverse * sums.right;
        ParabolaStretch s;
        s.samples = {kept[b], kept[end - 1] + 1};
        s.p = all[kept[b]].p_lab + rows.row(0).transpose().cwiseProduct(sigma);
        s.v = rows.row(1).transpose().cwiseProduct(sigma);
        s.a = rows.row(2).transpose().cwiseProduct(sigma);
        s.u_a = kLasting * std::sqrt(inverse(2, 2)) * sigma;
        stretches.push_back(s);
        end = b;
    }
    std::reverse(stretches.begin(), stretches.end());
    return stretches;
}

namespace {

/// Whether a fit to a stretch and the block beside it follows both; what a short stretch predicts
/// is too uncertain to judge by.
bool takes_in(
    std::span<const PositionSample> samples,
    const Stretch& known,
    const Stretch& wider,
    const StretchPath& path,
    double excess
) {
    const auto all = samples.subspan(wider.begin, wider.size());
    const auto fitted = path(wider, all);
    if (fitted.size() != all.size()) return false;
    std::vector<double> inside, outside;
    for (std::size_t i = wider.begin; i < wider.end; ++i) {
        const Vector3d r = samples[i].p_lab - fitted[i - wider.begin];
        const bool old = i >= known.begin && i < known.end;
        (old ? inside : outside).push_back((samples[i].whiten * r).norm() / excess);
    }
    return median(std::move(inside)) < kFits && median(std::move(outside)) < kFits;
}

}  // namespace

Stretch grow_stretch(
    std::span<const PositionSample> samples,
    Stretch known,
    const StretchPath& path,
    std::size_t block,
    int bad_blocks
) {
    const double excess = noise_excess(samples);
    bool ended[2] = {known.begin == 0, known.end == samples.size()};
    while (!ended[0] || !ended[1]) {
        const Stretch fitted = known;
        const std::size_t reach = std::max(block, fitted.size() / 4);
        const std::size_t first = fitted.begin - std::min(fitted.begin, ended[0] ? 0 : reach);
        const std::size_t last = std::min(fitted.end + (ended[1] ? 0 : reach), samples.size());
        const auto around = samples.subspan(first, last - first);
        const auto predicted = path(fitted, around);
        if (predicted.size() != around.size()) return known;
        for (const bool later : {false, true}) {
            if (ended[later]) continue;
            const std::size_t count = later ? last - fitted.end : fitted.begin - first;
            int bad = 0;
            std::size_t good = 0;
            for (std::size_t next = 0; next < count && bad < bad_blocks; next += block) {
                const std::size_t stop = std::min(next + block, count);
                const std::size_t from = later ? fitted.end + next : fitted.begin - stop;
                const auto part = samples.subspan(from, stop - next);
                const auto begin = predicted.begin() + static_cast<std::ptrdiff_t>(from - first);
                const std::vector<Vector3d> there(
                    begin, begin + static_cast<std::ptrdiff_t>(part.size())
                );
                const bool follows = off_by_median(part, there, excess) < kFollows;
                bad = follows ? 0 : bad + 1;
                if (follows) good = stop;
            }
            Stretch wider = known;
            if (good == 0) {
                good = std::min(block, count);
                (later ? wider.end : wider.begin) = later ? known.end + good : known.begin - good;
                if (!takes_in(samples, known, wider, path, excess)) good = 0;
                ended[later] = good == 0;
            }
            (later ? known.end : known.begin) = later ? known.end + good : known.begin - good;
            if (later ? known.end == samples.size() : known.begin == 0) ended[later] = true;
        }
    }
    return known;
}

Stretch without_ends(
    std::span<const PositionSample> samples,
    const Stretch& stretch,
    double share,
    std::size_t fewest
) {
    const auto cut =
        std::max(fewest, static_cast<std::size_t>(share * static_cast<double>(stretch.size())));
    return {
        stretch.begin + (stretch.begin > 0 ? cut : 0),
        stretch.end - (stretch.end < samples.size() ? cut : 0)};
}

}  // namespace kinectlab
