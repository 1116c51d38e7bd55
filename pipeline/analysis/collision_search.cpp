#include "pipeline/analysis/collision_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;

constexpr double kLook = 0.4;           // s to each side of a moment that may be the impact
constexpr std::size_t kFewest = 3;      // samples of a ball on each side
constexpr std::size_t kFewestKept = 5;  // of which the impact may be off by two
constexpr double kClearBend = 50.0;     // in squares of the noise
constexpr double kOpposite = -0.5;      // cosine between the changes of the two velocities
constexpr std::size_t kChunk = 6;       // samples by which a stretch grows
constexpr double kStrongDrag = 0.3;     // 1/s, more is no uniform motion
constexpr double kStray = 8.0;          // typical deviations from the median of five
constexpr double kUniform = 4.0;        // standard deviations

/// Two straight lines that meet, against one.
struct Bend {
    Vector3d squares_gained = Vector3d::Zero();
    Vector3d squares_left = Vector3d::Zero();
    Vector3d change = Vector3d::Zero();  // of the velocity
    double freedom = 0.0;
    std::ptrdiff_t fewer = 0;  // samples on the side that has fewer
    bool known = false;
};

/// Samples without the ones that lie far from their neighbours.
std::vector<PositionSample> without_strays(std::span<const PositionSample> all) {
    std::vector<Vector3d> off(all.size(), Vector3d::Zero());
    for (std::size_t i = 2; i + 2 < all.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> near;
            for (std::size_t k = i - 2; k <= i + 2; ++k)
                near.push_back(all[k].p_lab[axis]);
            off[i][axis] = std::abs(all[i].p_lab[axis] - median(std::move(near)));
        }
    Vector3d typical;
    for (int axis = 0; axis < 3; ++axis) {
        double sum = 0.0;
        for (const auto& one : off)
            sum += std::min(one[axis], 1e3);
        std::vector<double> values;
        for (const auto& one : off)
            values.push_back(one[axis]);
        std::sort(values.begin(), values.end());
        // The upper quartile: the median of five is often the sample itself.
        typical[axis] = std::max(values[values.size() * 3 / 4], 1e-3 * sum);
    }
    std::vector<PositionSample> kept;
    for (std::size_t i = 0; i < all.size(); ++i)
        if ((off[i].array() <= kStray * typical.array() + 1e-12).all()) kept.push_back(all[i]);
    return kept;
}

Bend bend_at(std::span<const PositionSample> all, double t, double look) {
    const auto before = [](const PositionSample& s, double time) {
        return s.t < time;
    };
    const auto first = std::lower_bound(all.begin(), all.end(), t - look, before);
    const auto last = std::lower_bound(first, all.end(), t + look, before);
    const auto middle = std::lower_bound(first, last, t, before);
    Bend bend;
    if (middle - first < static_cast<std::ptrdiff_t>(kFewest) ||
        last - middle < static_cast<std::ptrdiff_t>(kFewest))
        return bend;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
    Vector3d squares = Vector3d::Zero();
    const Vector3d origin = first->p_lab;
    for (auto s = first; s != last; ++s) {
        const double dt = s->t - t;
        const Vector3d row(1.0, dt, std::max(dt, 0.0));
        normal += row * row.transpose();
        right += row * (s->p_lab - origin).transpose();
        squares += (s->p_lab - origin).cwiseAbs2();
    }
    const Eigen::Matrix3d bent = normal.ldlt().solve(right);
    const Eigen::Matrix2d straight_normal = normal.topLeftCorner<2, 2>();
    const Eigen::Matrix<double, 2, 3> straight = straight_normal.ldlt().solve(right.topRows<2>());
    for (int axis = 0; axis < 3; ++axis) {
        const double fitted = right.col(axis).dot(bent.col(axis));
        bend.squares_left[axis] = std::max(squares[axis] - fitted, 0.0);
        bend.squares_gained[axis] =
            std::max(fitted - right.col(axis).head<2>().dot(straight.col(axis)), 0.0);
    }
    bend.change = bent.row(2).transpose();
    bend.fewer = std::min(middle - first, last - middle);
    bend.freedom = static_cast<double>(last - first) - 3.0;
    bend.known = bend.freedom > 0.0;
    return bend;
}

/// Typical variance of a ball's positions around two straight lines.
Vector3d noise(const std::vector<Bend>& bends) {
    Vector3d variance = Vector3d::Constant(1e-18);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const Bend& bend : bends)
            if (bend.known) values.push_back(bend.squares_left[axis] / bend.freedom);
        if (!values.empty()) variance[axis] = std::max(median(std::move(values)), 1e-18);
    }
    return variance;
}

/// How many samples on the side `step` (+1 or -1) of the impact show the ball keep its velocity,
/// and how far from it in time that holds. `all` is without strays: one would bend the line.
struct Uniform {
    std::size_t samples = 0;
    double reach_s = 0.0;
};

Uniform grow(
    std::span<const PositionSample> all,
    double t,
    int step,
    double look,
    double window_s,
    const Vector3d& variance
) {
    std::vector<const PositionSample*> side;
    for (const auto& s : all)
        if ((s.t - t) * step >= 0.0 && std::abs(s.t - t) <= window_s) side.push_back(&s);
    if (step < 0) std::reverse(side.begin(), side.end());
    std::size_t taken = 0;
    while (taken < side.size() && std::abs(side[taken]->t - t) <= look)
        ++taken;
    while (taken < side.size() && taken >= kFewest) {
        // From the newest stretch alone: over a long one drag would hide a cushion.
        const double from = side[taken - 1]->t;
        Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
        Eigen::Matrix<double, 2, 3> right = Eigen::Matrix<double, 2, 3>::Zero();
        for (std::size_t i = taken; i-- > 0;) {
            if (std::abs(side[i]->t - from) > look && taken - i > kFewest) break;
            const Eigen::Vector2d row(1.0, side[i]->t - from);
            normal += row * row.transpose();
            right += row * side[i]->p_lab.transpose();
        }
        const Eigen::Matrix2d inverse = normal.inverse();
        const Eigen::Matrix<double, 2, 3> line = inverse * right;
        const double speed = line.row(1).norm();
        const std::size_t end = std::min(taken + kChunk, side.size());
        std::vector<double> off;
        for (std::size_t i = taken; i < end; ++i) {
            const Eigen::Vector2d row(1.0, side[i]->t - from);
            const double reach = std::abs(row[1]) + look / 2.0;
            const double slack = 0.5 * kStrongDrag * speed * reach * reach;
            const Vector3d d = side[i]->p_lab - line.transpose() * row;
            const double known = 1.0 + row.dot(inverse * row);
            const Vector3d allowed = (variance * known).cwiseSqrt() * kUniform;
            off.push_back((d.array().abs() / (allowed.array() + slack)).maxCoeff());
        }
        if (median(std::move(off)) > 1.0) break;
        taken = end;
    }
    return {taken, taken == 0 ? 0.0 : std::abs(side[taken - 1]->t - t)};
}

}  // namespace

Result<Impact> find_impact(
    std::span<const PositionSample> all_a, std::span<const PositionSample> all_b, double window_s
) {
    const std::array<std::vector<PositionSample>, 2> balls{
        without_strays(all_a), without_strays(all_b)};
    std::vector<double> steps;
    for (std::size_t i = 1; i < all_a.size(); ++i)
        steps.push_back(all_a[i].t - all_a[i - 1].t);
    const double frame = median(std::move(steps));
    const double look = std::max(kLook, 5.0 * frame);

    std::vector<double> times;
    for (std::size_t i = 1; i < balls[0].size(); ++i)
        for (const double part : {0.25, 0.75})
            times.push_back((1.0 - part) * balls[0][i - 1].t + part * balls[0][i].t);
    std::array<std::vector<Bend>, 2> bends;
    for (std::size_t k = 0; k < 2; ++k)
        for (const double t : times)
            bends[k].push_back(bend_at(balls[k], t, look));
    const std::array<Vector3d, 2> variance{noise(bends[0]), noise(bends[1])};

    struct Found {
        double t = 0.0;
        double bent = 0.0;
    };
    bool compared = false;
    const auto look_for = [&](std::size_t fewest) {
        Found found;
        for (std::size_t i = 0; i < times.size(); ++i) {
            const Bend& a = bends[0][i];
            const Bend& b = bends[1][i];
            if (!a.known || !b.known) continue;
            compared = true;
            if (std::min(a.fewer, b.fewer) < static_cast<std::ptrdiff_t>(fewest)) continue;
            if (a.change.dot(b.change) > kOpposite * a.change.norm() * b.change.norm()) continue;
            const double bent = std::min(
                a.squares_gained.cwiseQuotient(variance[0]).sum(),
                b.squares_gained.cwiseQuotient(variance[1]).sum()
            );
            if (bent > found.bent) found = {times[i], bent};
        }
        return found;
    };
    // Where a side has but three frames slow noise bends as much as an impact; one that is clear
    // elsewhere is the impact.
    Found found = look_for(kFewest);
    const Found well_seen = look_for(kFewestKept);
    if (well_seen.bent >= kClearBend &&
        std::abs(well_seen.t - found.t) > static_cast<double>(kFewestKept) * frame)
        found = well_seen;
    Impact impact;
    impact.t = found.t;
    if (!compared)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "the two balls were never seen for three frames before and after one moment",
            "start the recording before they meet, stop it later, and see that both stay in the "
            "picture"
        );
    if (found.bent < kClearBend)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "no impact was found: at no moment do both balls change their velocities at once and "
            "in opposite directions",
            "let them meet within the picture, faster, with a second of free motion before and "
            "after"
        );
    const std::array<std::span<const PositionSample>, 2> all{all_a, all_b};
    for (std::size_t k = 0; k < 2; ++k) {
        const Uniform later = grow(balls[k], impact.t, 1, look, window_s, variance[k]);
        const Uniform earlier = grow(balls[k], impact.t, -1, look, window_s, variance[k]);
        const std::size_t before = earlier.samples;
        const std::size_t after = later.samples;
        const auto index_of = [&](double t) {
            const auto is_before = [](const PositionSample& s, double time) {
                return s.t < time;
            };
            const auto found = std::lower_bound(all[k].begin(), all[k].end(), t, is_before);
            return static_cast<std::size_t>(found - all[k].begin());
        };
        const double rounding = 1e-6;
        impact.moving[k] = {
            index_of(impact.t - earlier.reach_s - rounding),
            index_of(impact.t + later.reach_s + rounding)};
        if (before < kFewestKept || after < kFewestKept)
            return fail(
                ErrorCode::bad_data,
                "samples",
                fmt::format(
                    "ball {} was seen in {} frames before the impact and {} after it",
                    k == 0 ? "a" : "b",
                    before,
                    after
                ),
                "at least 5 are needed on each side, and a second's worth is better"
            );
    }
    return impact;
}

}  // namespace kinectlab
