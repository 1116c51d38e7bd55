#include "pipeline/analysis/projectile_model.hpp"

#include <cmath>

namespace kinectlab {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStep = 1.0 / 60.0;  // s
constexpr int kMostSteps = 6000;

struct Flight {
    explicit Flight(const VectorXd& x)
        : p(x.segment<3>(kFlightX)),
          v(x.segment<3>(kFlightVx)),
          pull(-x[kFlightG] * flight_up(x)),
          drag(x[kFlightDrag]) {}

    [[nodiscard]] Vector3d acceleration(const Vector3d& speed) const {
        return pull - drag * speed.norm() * speed;
    }

    void step(double h) {
        const Vector3d a1 = acceleration(v);
        const Vector3d v2 = v + h / 2 * a1;
        const Vector3d a2 = acceleration(v2);
        const Vector3d v3 = v + h / 2 * a2;
        const Vector3d a3 = acceleration(v3);
        const Vector3d v4 = v + h * a3;
        p += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + acceleration(v4));
    }

    void go(double span) {
        const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(span) / kStep)));
        for (int i = 0; i < steps; ++i)
            step(span / steps);
    }

    Vector3d p;
    Vector3d v;
    Vector3d pull;
    double drag;
};

}  // namespace

Vector3d flight_up(const VectorXd& parameters) {
    return Vector3d(parameters[kFlightTiltX], parameters[kFlightTiltY], 1.0).normalized();
}

Vector3d flight_velocity(const VectorXd& parameters) {
    return parameters.segment<3>(kFlightVx);
}

void projectile_path(
    const VectorXd& parameters, double t0, std::span<const double> t, std::span<Vector3d> p
) {
    std::size_t later = 0;
    while (later < t.size() && t[later] < t0)
        ++later;
    Flight forward(parameters);
    double at = t0;
    for (std::size_t i = later; i < t.size(); ++i) {
        forward.go(t[i] - at);
        at = t[i];
        p[i] = forward.p;
    }
    Flight back(parameters);
    at = t0;
    for (std::size_t i = later; i-- > 0;) {
        back.go(t[i] - at);
        at = t[i];
        p[i] = back.p;
    }
}

FlightTop flight_top(const VectorXd& parameters) {
    const Vector3d up = flight_up(parameters);
    Flight flight(parameters);
    const Vector3d start = flight.p;
    double time = 0.0;
    for (int i = 0; i < kMostSteps && flight.v.dot(up) > 0.0; ++i) {
        const double rest = -flight.v.dot(up) / flight.acceleration(flight.v).dot(up);
        const double h = std::min(rest, kStep);
        flight.step(h);
        time += h;
        if (h < 1e-7) break;  // as near to the top as rounding allows
    }
    return {(flight.p - start).dot(up), time};
}

}  // namespace kinectlab
