#include "pipeline/track/radius_check.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr TimeNs kMemory = kNsPerSecond / 2;
constexpr double kReach_m = 0.3;  // between two frames: 9 m/s at 30 Hz
constexpr int kFrames = 60;
constexpr double kMostOff = 0.05;      // of the radius; callipers and paint are below that
constexpr double kGate = 5.0;          // standard uncertainties
constexpr double kCommonError = 5e-3;  // of the radius: a sensor's own, alike in all frames

}  // namespace

bool RadiusCheck::is_of(const Sphere& ball, TimeNs t) const {
    return t - t_ <= kMemory && (ball.centre_cam - place_cam_).norm() < kReach_m;
}

bool RadiusCheck::follow(const Sphere& ball, TimeNs t) {
    if (!is_of(ball, t)) *this = {};
    place_cam_ = ball.centre_cam;
    t_ = t;
    return frames_ < kFrames || is_other(ball);
}

void RadiusCheck::add(double radius_m, double radius_u) {
    const double weight = 1.0 / (radius_u * radius_u);
    sum_ += weight * radius_m;
    weight_ += weight;
    ++frames_;
}

bool RadiusCheck::is_other(const Sphere& ball) const {
    if (frames_ == 0) return false;
    const double off = std::abs(sum_ / weight_ - ball.radius);
    const double u = std::hypot(1.0 / std::sqrt(weight_), kCommonError * ball.radius);
    return off > kMostOff * ball.radius && off > kGate * u;
}

}  // namespace kinectlab
