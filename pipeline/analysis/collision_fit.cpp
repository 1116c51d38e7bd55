#include "pipeline/analysis/collision_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace kinectlab {
namespace collision {
namespace {

Eigen::Index ball_start(std::size_t ball) {
    return kSlope + 2 + 9 * static_cast<Eigen::Index>(ball);
}

}  // namespace

Eigen::Vector3d centre(const Eigen::VectorXd& p, std::size_t ball) {
    return p.segment<3>(ball_start(ball));
}

Eigen::Vector3d before(const Eigen::VectorXd& p, std::size_t ball) {
    return p.segment<3>(ball_start(ball) + 3);
}

Eigen::Vector3d after(const Eigen::VectorXd& p, std::size_t ball) {
    return p.segment<3>(ball_start(ball) + 6);
}

Eigen::Vector3d position(const Eigen::VectorXd& p, std::size_t ball, double t) {
    const double s = t - p[kTime];
    const double x = p[kDrag] * s;
    const double way = std::abs(x) < 1e-6 ? s * (1.0 - x / 2.0) : -s * std::expm1(-x) / x;
    Eigen::Vector3d at = centre(p, ball) + way * (s < 0.0 ? before(p, ball) : after(p, ball));
    at.head<2>() += 0.5 * s * s * p.segment<2>(kSlope);
    return at;
}

}  // namespace collision

namespace {

using Eigen::Vector3d;

/// Two straight lines that meet at the impact.
Eigen::Matrix3d lines(std::span<const PositionSample> samples, double t) {
    Eigen::Matrix3d normal = 1e-12 * Eigen::Matrix3d::Identity();
    Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
    for (const auto& s : samples) {
        const Vector3d row(1.0, std::min(s.t - t, 0.0), std::max(s.t - t, 0.0));
        normal += row * row.transpose();
        right += row * s.p_lab.transpose();
    }
    return normal.ldlt().solve(right);
}

}  // namespace

Result<ResidualFit> fit_collision(
    const std::array<std::span<const PositionSample>, 2>& balls,
    const Impact& impact,
    const CollisionPriors& priors
) {
    std::vector<ResidualPlace> places;
    std::vector<const PositionSample*> samples;
    std::vector<PathParameter> parameters(collision::kCount);
    parameters[collision::kTime] = {impact.t, 0.01, 0.0, -1.0};
    parameters[collision::kDrag] = {0.0, 0.1, 0.0, priors.drag_u};
    for (std::size_t i = 0; i < 2; ++i)
        parameters[collision::kSlope + i] = {0.0, 0.01, 0.0, priors.slope_u};
    for (std::size_t ball = 0; ball < 2; ++ball) {
        const auto [begin, end] = impact.moving[ball];
        const auto used = balls[ball].subspan(begin, end - begin);
        const Eigen::Matrix3d start = lines(used, impact.t);
        for (std::size_t i = 0; i < 9; ++i)
            parameters[4 + 9 * ball + i] = {
                start(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)),
                0.01,
                0.0,
                -1.0};
        for (const auto& s : used) {
            places.push_back({static_cast<int>(ball), s.t});
            samples.push_back(&s);
        }
    }
    const ResidualModel model = [&](const Eigen::VectorXd& p, std::span<Vector3d> r) {
        for (std::size_t i = 0; i < r.size(); ++i)
            r[i] =
                samples[i]->whiten *
                (samples[i]->p_lab -
                 collision::position(p, static_cast<std::size_t>(places[i].series), places[i].t));
    };
    return fit_residuals(places, model, parameters);
}

}  // namespace kinectlab
