#include "pipeline/track/predicted_point.hpp"

namespace kinectlab {
namespace {

constexpr double kUnknownSpeed = 1.5;  // m/s, standard deviation before anything is known
// Power of the acceleration, m²/s³: 4 m/s² that last a quarter of a second, as on a pendulum of
// 30° or in a hand. One frame later a place is known to 7 mm, a second later to a metre.
constexpr double kJerkiness = 4.0;

}  // namespace

PredictedPoint::PredictedPoint(TimeNs t, const Eigen::Vector3d& p_cam, double variance)
    : t_(t), p_(p_cam), pp_(variance), vv_(kUnknownSpeed * kUnknownSpeed) {}

Eigen::Vector3d PredictedPoint::at(TimeNs t) const {
    return p_ + to_seconds(t - t_) * v_;
}

double PredictedPoint::variance_at(TimeNs t) const {
    const double dt = to_seconds(t - t_);
    return pp_ + dt * (2.0 * pv_ + dt * (vv_ + dt * kJerkiness / 3.0));
}

void PredictedPoint::observe(TimeNs t, const Eigen::Vector3d& p_cam, double variance) {
    const double dt = to_seconds(t - t_);
    const Eigen::Vector3d innovation = p_cam - at(t);
    const double pp = variance_at(t);
    const double pv = pv_ + dt * (vv_ + 0.5 * dt * kJerkiness);
    const double vv = vv_ + dt * kJerkiness;
    const double s = pp + variance;
    p_ = at(t) + pp / s * innovation;
    v_ += pv / s * innovation;
    pp_ = pp * variance / s;
    pv_ = pv * variance / s;
    vv_ = vv - pv * pv / s;
    t_ = t;
}

}  // namespace kinectlab
