#include "pipeline/analysis/smooth_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "pipeline/analysis/attitude_samples.hpp"
#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/position_samples.hpp"

namespace kinectlab {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr std::size_t kFewest = 8;  // samples that make a stretch
constexpr double kOutlier = 5.0;    // standard deviations
constexpr int kRounds = 12;

Result<std::vector<FloorSample>> collect(const Trajectory& trajectory, bool& has_heading) {
    const auto positions = collect_position_samples(trajectory, kFewest);
    if (!positions) return tl::unexpected(positions.error());
    const auto& all = trajectory.samples;
    has_heading = std::all_of(positions->begin(), positions->end(), [&](const auto& s) {
        return all[s.index].has_orientation;
    });
    if (has_heading)
        if (const auto ok = collect_attitudes(trajectory, false, kFewest); !ok)
            return tl::unexpected(ok.error());
    std::vector<FloorSample> samples;
    double heading = 0.0;
    for (const auto& s : *positions) {
        FloorSample one{s.index, s.t, s.p_lab, Matrix3d::Zero()};
        one.spread.topLeftCorner<2, 2>() =
            Matrix3d(s.whiten.inverse()).topLeftCorner<2, 2>();  // lower triangles
        one.value.z() = 0.0;
        if (has_heading) {
            const MotionSample& seen = all[s.index];
            const Vector3d ahead = seen.q_lab_obj * Vector3d::UnitX();
            const double now = std::atan2(ahead.y(), ahead.x());
            heading = samples.empty()
                          ? now
                          : heading + std::remainder(now - heading, 2.0 * std::numbers::pi);
            one.value.z() = heading;
            const double variance = seen.covariance(5, 5);
            one.spread(2, 2) = variance > 0.0 ? std::sqrt(variance) : 0.01;
        }
        samples.push_back(one);
    }
    return samples;
}

/// Samples [first, last) to make a cubic at sample `i` of, and its weights.
SmoothPoint local_cubic(
    std::span<const FloorSample> all,
    std::size_t begin,
    std::size_t end,
    std::size_t i,
    double half_window_s
) {
    const double t = all[i].t;
    const double start = all[begin].t;
    const double stop = all[end - 1].t;
    double from = std::max(t - half_window_s, start);
    double to = std::min(t + half_window_s, stop);
    if (t - half_window_s < start) to = std::min(start + 2.0 * half_window_s, stop);
    if (t + half_window_s > stop) from = std::max(stop - 2.0 * half_window_s, start);
    const double reach = 1.001 * std::max(t - from, to - t);
    SmoothPoint point;
    point.first = begin;
    while (all[point.first].t < from - 1e-9)
        ++point.first;
    std::size_t last = point.first;
    while (last < end && all[last].t <= to + 1e-9)
        ++last;
    Eigen::Matrix4d normal = 1e-9 * Eigen::Matrix4d::Identity();
    const auto row = [&](std::size_t k) {
        const double x = (all[k].t - t) / reach;
        return Vector4d(1.0, x, x * x, x * x * x);
    };
    const auto weight = [&](std::size_t k) {
        const double x = (all[k].t - t) / reach;
        return 1.0 - x * x;
    };
    for (std::size_t k = point.first; k < last; ++k)
        normal += weight(k) * row(k) * row(k).transpose();
    const Eigen::Matrix4d inverse = normal.inverse();
    point.value.setZero();
    point.slope.setZero();
    point.bend.setZero();
    for (std::size_t k = point.first; k < last; ++k) {
        const Vector4d w = inverse * row(k) * weight(k);
        point.value_weights.push_back(w[0]);
        point.slope_weights.push_back(w[1] / reach);
        point.bend_weights.push_back(2.0 * w[2] / (reach * reach));
        // From the sample itself on, so that nothing large cancels.
        const Vector3d d = all[k].value - all[i].value;
        point.value += w[0] * d;
        point.slope += point.slope_weights.back() * d;
        point.bend += point.bend_weights.back() * d;
    }
    point.value += all[i].value;
    return point;
}

void smooth(SmoothPath& path, double half_window_s) {
    std::vector<FloorSample> kept;
    path.stretch_ends.clear();
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= path.samples.size(); ++i) {
        if (i < path.samples.size() && path.samples[i].t - path.samples[i - 1].t <= half_window_s)
            continue;
        if (i - begin >= kFewest &&
            path.samples[i - 1].t - path.samples[begin].t >= half_window_s) {
            for (std::size_t k = begin; k < i; ++k)
                kept.push_back(path.samples[k]);
            path.stretch_ends.push_back(kept.size());
        }
        begin = i;
    }
    path.samples = std::move(kept);
    path.points.clear();
    begin = 0;
    for (const std::size_t end : path.stretch_ends) {
        for (std::size_t i = begin; i < end; ++i)
            path.points.push_back(local_cubic(path.samples, begin, end, i, half_window_s));
        begin = end;
    }
}

/// How far each sample lies from the smooth path, in its own uncertainty.
std::vector<double> distances(const SmoothPath& path) {
    std::vector<double> d;
    for (std::size_t i = 0; i < path.samples.size(); ++i) {
        const Vector3d off = path.samples[i].value - path.points[i].value;
        const Matrix3d& spread = path.samples[i].spread;
        double squares =
            Eigen::Vector2d(spread.topLeftCorner<2, 2>().inverse() * off.head<2>()).squaredNorm();
        if (path.has_heading) squares += std::pow(off[2] / spread(2, 2), 2);
        d.push_back(std::sqrt(squares));
    }
    return d;
}

/// Size and memory of the noise, from a cubic through each separate window.
void judge_noise(SmoothPath& path, double half_window_s) {
    std::vector<FitSeries> windows;
    std::size_t i = 0;
    for (const std::size_t end : path.stretch_ends)
        while (i < end) {
            FitSeries series;
            const double start = path.samples[i].t;
            std::size_t last = i;
            while (last < end && path.samples[last].t - start < 2.0 * half_window_s)
                ++last;
            for (std::size_t k = i; k < last && last - i >= kFewest; ++k) {
                const double x = (path.samples[k].t - start) / half_window_s - 1.0;
                Jacobian3 j = Jacobian3::Zero(3, 12);
                for (int axis = 0; axis < 3; ++axis)
                    j.row(axis).segment<4>(4 * axis) << 1.0, x, x * x, x * x * x;
                series.t.push_back(path.samples[k].t);
                series.jacobian.push_back(j);
                // Not against the smooth path, which has taken up some of the noise.
                series.residual.emplace_back(path.samples[k].value - path.samples[i].value);
            }
            if (!series.t.empty()) windows.push_back(std::move(series));
            i = last;
        }
    // What is left of each axis after the cubics, against what the tracker said of it.
    Vector3d squares = Vector3d::Zero();
    double freedom = 0.0;
    for (const FitSeries& series : windows) {
        const auto n = static_cast<Eigen::Index>(series.t.size());
        Eigen::MatrixX4d powers(n, 4);
        Eigen::MatrixX3d rest(n, 3);
        for (Eigen::Index k = 0; k < n; ++k) {
            powers.row(k) = series.jacobian[static_cast<std::size_t>(k)].row(0).head<4>();
            rest.row(k) = series.residual[static_cast<std::size_t>(k)].transpose();
        }
        const Eigen::MatrixX3d left = rest - powers * powers.householderQr().solve(rest);
        squares += left.colwise().squaredNorm().transpose();
        freedom += static_cast<double>(n) - 4.0;
    }
    Vector3d told = Vector3d::Zero();
    for (const auto& s : path.samples)
        told +=
            (s.spread * s.spread.transpose()).diagonal() / static_cast<double>(path.samples.size());
    Vector3d scale = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
        if (told[axis] > 0.0)
            scale[axis] = std::sqrt(std::max(squares[axis] / freedom, 1e-18) / told[axis]);
    const int directions = path.has_heading ? 3 : 2;
    path.reduced_chi2 = scale.head(directions).squaredNorm() / directions;
    for (auto& s : path.samples)
        s.spread = scale.asDiagonal() * s.spread;

    std::vector<double> steps;
    for (std::size_t k = 1; k < path.samples.size(); ++k)
        steps.push_back(path.samples[k].t - path.samples[k - 1].t);
    NoiseMemories noise(median(std::move(steps)), 2.0 * half_window_s, directions);
    std::size_t at = 0;
    for (FitSeries& series : windows) {
        for (std::size_t k = 0; k < series.t.size(); ++k) {
            while (path.samples[at].t < series.t[k])
                ++at;
            Matrix3d whiten = Matrix3d::Zero();
            const Matrix3d& spread = path.samples[at].spread;
            whiten.topLeftCorner<2, 2>() = spread.topLeftCorner<2, 2>().inverse();
            if (path.has_heading) whiten(2, 2) = 1.0 / spread(2, 2);
            series.residual[k] = whiten * series.residual[k];
            series.jacobian[k] = (whiten * series.jacobian[k]).leftCols(4 * directions).eval();
        }
        noise.add({&series, 1}, Eigen::VectorXd::Zero(4 * directions));
    }
    path.memories = noise.weighed();
}

}  // namespace

Eigen::MatrixXd SmoothPath::covariance(std::size_t first, std::vector<Jacobian3> gradient) const {
    FitSeries series;
    for (std::size_t k = 0; k < gradient.size(); ++k) {
        series.t.push_back(samples[first + k].t);
        series.jacobian.emplace_back(samples[first + k].spread.transpose() * gradient[k]);
    }
    const Eigen::Index n = series.jacobian.front().cols();
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
    for (const NoiseMemory& memory : memories)
        if (memory.weight > 1e-2) sum += memory.weight * score_covariance(series, memory);
    return sum;
}

Result<SmoothPath> smooth_path(const Trajectory& trajectory, double half_window_s) {
    SmoothPath path;
    auto samples = collect(trajectory, path.has_heading);
    if (!samples) return tl::unexpected(samples.error());
    path.samples = std::move(*samples);
    const std::size_t all = path.samples.size();
    for (int round = 0; round < kRounds; ++round) {
        smooth(path, half_window_s);
        if (path.points.empty())
            return fail(
                ErrorCode::bad_data,
                "samples",
                "the object was nowhere seen for long enough to smooth its path: " +
                    std::to_string(all) + " frames in all",
                "see that it stays in the picture for a second or more"
            );
        const auto d = distances(path);
        const double typical = median(d) / std::sqrt(path.has_heading ? 2.366 : 1.386);
        // The farthest first: what lies near a stray sample looks astray too.
        const double limit =
            std::max(kOutlier * typical, 0.5 * *std::max_element(d.begin(), d.end()));
        std::vector<FloorSample> kept;
        for (std::size_t i = 0; i < d.size(); ++i)
            if (d[i] <= limit || limit <= 0.0) kept.push_back(path.samples[i]);
        const std::size_t strays = d.size() - kept.size();
        if (strays == 0) break;
        path.outliers += static_cast<int>(strays);
        path.samples = std::move(kept);
        if (round == kRounds - 1) smooth(path, half_window_s);
    }
    judge_noise(path, half_window_s);
    for (auto& point : path.points) {
        std::vector<Jacobian3> gradient;
        for (const double w : point.slope_weights)
            gradient.emplace_back(w * Matrix3d::Identity());
        point.slope_covariance = path.covariance(point.first, std::move(gradient));
    }
    return path;
}

}  // namespace kinectlab
