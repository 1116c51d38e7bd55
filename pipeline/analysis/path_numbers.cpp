#include "pipeline/analysis/path_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pipeline/analysis/greatest_speed.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kStanding = 3.0;  // uncertainties of the speed
// The local cubic's slope of sin(Ωt) is low by this times (Ω half_window)⁴ (Epanechnikov's
// moments).
constexpr double kSlopeLoss = 1.3e-3;

enum Column { kLength, kDisplacement, kTurn, kColumns };

/// How the numbers change with each sample.
class Gradients {
public:
    explicit Gradients(const SmoothPath& path)
        : path_(path), all_(path.samples.size(), Jacobian3::Zero(3, kColumns)) {}

    void add(
        Column column,
        const SmoothPoint& point,
        const std::vector<double>& weights,
        const Vector3d& direction
    ) {
        for (std::size_t k = 0; k < weights.size(); ++k)
            all_[point.first + k].col(column) += weights[k] * direction;
    }

    [[nodiscard]] Eigen::VectorXd u() {
        return path_.covariance(0, std::move(all_)).diagonal().cwiseMax(0.0).cwiseSqrt();
    }

private:
    const SmoothPath& path_;
    std::vector<Jacobian3> all_;
};

Vector3d flat(const Vector2d& v) {
    return {v.x(), v.y(), 0.0};
}

/// Speed without what the noise across it adds, heading and turning rate at one time.
void add_point(const SmoothPath& path, std::size_t i, PathNumbers& numbers) {
    const SmoothPoint& point = path.points[i];
    const Vector2d v = point.slope.head<2>();
    const Eigen::Matrix2d covariance = point.slope_covariance.topLeftCorner<2, 2>();
    const double size = v.norm();
    const Vector2d along = size > 0.0 ? Vector2d(v / size) : Vector2d(Vector2d::UnitX());
    const Vector2d across(-along.y(), along.x());
    const double u = std::sqrt(along.dot(covariance * along));
    const double u_across_sq = across.dot(covariance * across);
    const bool stands = size < kStanding * std::sqrt(covariance.trace() / 2.0) || size == 0.0;
    numbers.speed.push_back(stands ? 0.0 : size - u_across_sq / (2.0 * size));
    numbers.speed_u.push_back(u);
    if (path.has_heading) {
        numbers.heading.push_back(point.value.z());
        numbers.turning.push_back(point.slope.z());
        numbers.turning_u.push_back(std::sqrt(point.slope_covariance(2, 2)));
        return;
    }
    if (stands) {
        numbers.heading.push_back(kNan);
        numbers.turning.push_back(kNan);
        numbers.turning_u.push_back(kNan);
        return;
    }
    double before = 0.0;
    for (auto h = numbers.heading.rbegin(); h != numbers.heading.rend(); ++h)
        if (std::isfinite(*h)) {
            before = *h;
            break;
        }
    const double now = std::atan2(v.y(), v.x());
    numbers.heading.push_back(before + std::remainder(now - before, 2.0 * std::numbers::pi));
    const Vector2d a = point.bend.head<2>();
    numbers.turning.push_back((v.x() * a.y() - v.y() * a.x()) / (size * size));
    // By the acceleration across; the velocity's share is small beside it.
    std::vector<Jacobian3> gradient;
    for (const double w : point.bend_weights)
        gradient.emplace_back(flat(w / size * across));
    numbers.turning_u.push_back(std::sqrt(path.covariance(point.first, std::move(gradient))(0, 0)));
}

void add_length(const SmoothPath& path, PathNumbers& numbers, Gradients& gradients) {
    std::size_t begin = 0;
    double standing = 0.0;
    double turning_sq = 0.0;
    double time = 0.0;
    for (const std::size_t end : path.stretch_ends) {
        for (std::size_t i = begin; i < end; ++i) {
            const double from = i > begin ? path.samples[i - 1].t : path.samples[i].t;
            const double to = i + 1 < end ? path.samples[i + 1].t : path.samples[i].t;
            const double dt = 0.5 * (to - from);
            time += dt;
            numbers.length.value += dt * numbers.speed[i];
            if (numbers.speed[i] == 0.0) {
                standing += dt;
                continue;
            }
            const SmoothPoint& point = path.points[i];
            if (std::isfinite(numbers.turning[i]))
                turning_sq +=
                    dt *
                    std::max(
                        std::pow(numbers.turning[i], 2) - std::pow(numbers.turning_u[i], 2), 0.0
                    );
            gradients.add(
                kLength, point, point.slope_weights, flat(dt * point.slope.head<2>().normalized())
            );
        }
        if (begin > 0) {
            const SmoothPoint& last = path.points[begin - 1];
            const SmoothPoint& next = path.points[begin];
            const double dt = path.samples[begin].t - path.samples[begin - 1].t;
            const double chord = (next.value - last.value).head<2>().norm();
            numbers.length.value += chord;
            numbers.gaps_s += dt;
            const double driven = 0.5 * dt * (numbers.speed[begin - 1] + numbers.speed[begin]);
            numbers.gaps_u = std::hypot(numbers.gaps_u, std::max(driven - chord, 0.02 * chord));
        }
        begin = end;
    }
    numbers.standing_share = standing / time;
    numbers.smoothing_share = turning_sq / time;  // made a share where the window is known
}

void add_turn(const SmoothPath& path, PathNumbers& numbers, Gradients& gradients) {
    const auto known = [](double h) {
        return std::isfinite(h);
    };
    const auto& h = numbers.heading;
    const auto first = std::find_if(h.begin(), h.end(), known);
    const auto last = std::find_if(h.rbegin(), h.rend(), known);
    if (first == h.end()) {
        numbers.turn = {kNan, kNan};
        return;
    }
    numbers.turn.value = *last - *first;
    const std::size_t ends[] = {
        static_cast<std::size_t>(first - h.begin()), static_cast<std::size_t>(h.rend() - last) - 1};
    for (int k = 0; k < 2; ++k) {
        const SmoothPoint& point = path.points[ends[k]];
        const double sign = k == 0 ? -1.0 : 1.0;
        if (path.has_heading) {
            gradients.add(kTurn, point, point.value_weights, sign * Vector3d::UnitZ());
            continue;
        }
        const Vector2d v = point.slope.head<2>();
        gradients.add(
            kTurn,
            point,
            point.slope_weights,
            flat(sign / v.squaredNorm() * Vector2d(-v.y(), v.x()))
        );
    }
}

}  // namespace

Result<PathNumbers> path_numbers(const SmoothPath& path, double half_window_s) {
    PathNumbers numbers;
    for (std::size_t i = 0; i < path.points.size(); ++i)
        add_point(path, i, numbers);
    Gradients gradients(path);
    add_length(path, numbers, gradients);
    const double omega_sq = numbers.smoothing_share * half_window_s * half_window_s;
    numbers.smoothing_share = kSlopeLoss * omega_sq * omega_sq;
    numbers.greatest_speed = greatest_speed(path, numbers, half_window_s);
    add_turn(path, numbers, gradients);
    const SmoothPoint& first = path.points.front();
    const SmoothPoint& last = path.points.back();
    const Vector2d apart = (last.value - first.value).head<2>();
    numbers.displacement.value = apart.norm();
    const Vector3d direction = flat(apart.normalized());
    gradients.add(kDisplacement, last, last.value_weights, direction);
    gradients.add(kDisplacement, first, first.value_weights, -direction);
    const Eigen::VectorXd u = gradients.u();
    numbers.length.u = u[kLength];
    numbers.displacement.u = u[kDisplacement];
    numbers.turn.u = u[kTurn];
    if (!path.has_heading && numbers.standing_share > 0.9)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "the object does not move by more than its noise",
            "let it drive, or choose a longer half_window_s for a very slow one"
        );
    return numbers;
}

}  // namespace kinectlab
