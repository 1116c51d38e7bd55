#include "pipeline/analysis/greatest_speed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;

constexpr int kDraws = 60;
constexpr double kCalm = 1.5;    // typical uncertainties: ends of the path are known worse
constexpr double kCalmer = 3.0;  // half windows over which the calmer course is made

/// Local parabolas through the speeds at the places of `calm`.
std::vector<double> calmer_course(
    const SmoothPath& path,
    const std::vector<double>& speed,
    const std::vector<std::size_t>& calm,
    double reach
) {
    std::vector<double> course;
    std::size_t from = 0;
    for (const std::size_t i : calm) {
        const double t = path.samples[i].t;
        while (path.samples[calm[from]].t < t - reach)
            ++from;
        Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
        Vector3d right = Vector3d::Zero();
        for (std::size_t k = from; k < calm.size(); ++k) {
            const double x = (path.samples[calm[k]].t - t) / reach;
            if (x > 1.0) break;
            const Vector3d row(1.0, x, x * x);
            normal += (1.0 - x * x) * row * row.transpose();
            right += (1.0 - x * x) * speed[calm[k]] * row;
        }
        course.push_back(normal.ldlt().solve(right)[0]);
    }
    return course;
}

/// Noise of all samples with one of the path's memories.
std::vector<Vector3d> draw(const SmoothPath& path, double quantile, std::mt19937_64& random) {
    NoiseMemory memory = path.memories.front();
    for (const NoiseMemory& one : path.memories) {
        memory = one;
        quantile -= one.weight;
        if (quantile <= 0.0) break;
    }
    std::normal_distribution<double> normal;
    const auto fresh = [&] {
        const double x = normal(random);
        const double y = normal(random);
        return Vector3d(x, y, 0.0);
    };
    std::vector<Vector3d> noise;
    Vector3d lasting = fresh();
    for (std::size_t i = 0; i < path.samples.size(); ++i) {
        if (i > 0) {
            const double dt = path.samples[i].t - path.samples[i - 1].t;
            const double stay = memory.time_s > 0.0 ? std::exp(-dt / memory.time_s) : 0.0;
            lasting = stay * lasting + std::sqrt(1.0 - stay * stay) * fresh();
        }
        const Vector3d unit =
            std::sqrt(memory.share) * lasting + std::sqrt(1.0 - memory.share) * fresh();
        noise.emplace_back(std::sqrt(memory.variance) * path.samples[i].spread * unit);
    }
    return noise;
}

}  // namespace

PathNumber greatest_speed(
    const SmoothPath& path, const PathNumbers& numbers, double half_window_s
) {
    const double typical = median(numbers.speed_u);
    std::vector<std::size_t> calm;
    for (std::size_t i = 0; i < numbers.speed.size(); ++i)
        if (numbers.speed[i] > 0.0 && numbers.speed_u[i] <= kCalm * typical) calm.push_back(i);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (calm.empty()) return {nan, nan};
    const auto course = calmer_course(path, numbers.speed, calm, kCalmer * half_window_s);
    const double top = *std::max_element(course.begin(), course.end());
    std::mt19937_64 random(1);
    std::vector<double> tops;
    for (int k = 0; k < kDraws; ++k) {
        const auto noise = draw(path, (k + 0.5) / kDraws, random);
        double greatest = 0.0;
        for (std::size_t c = 0; c < calm.size(); ++c) {
            const SmoothPoint& point = path.points[calm[c]];
            Vector3d off = Vector3d::Zero();
            for (std::size_t w = 0; w < point.slope_weights.size(); ++w)
                off += point.slope_weights[w] * noise[point.first + w];
            const double along = off.head<2>().dot(point.slope.head<2>().normalized());
            greatest = std::max(greatest, course[c] + along);
        }
        tops.push_back(greatest);
    }
    double mean = 0.0;
    for (const double one : tops)
        mean += one / kDraws;
    double squares = 0.0;
    for (const double one : tops)
        squares += (one - mean) * (one - mean);
    double seen = 0.0;
    for (const std::size_t i : calm)
        seen = std::max(seen, numbers.speed[i]);
    return {seen - (mean - top), std::sqrt(squares / (kDraws - 1))};
}

}  // namespace kinectlab
