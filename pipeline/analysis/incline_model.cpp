#include "pipeline/analysis/incline_model.hpp"

#include <cmath>

namespace kinectlab {

Eigen::Vector3d incline_direction(const Eigen::VectorXd& x) {
    const double level = std::cos(x[kInclineSlope]);
    return {
        level * std::cos(x[kInclineHeading]),
        level * std::sin(x[kInclineHeading]),
        -std::sin(x[kInclineSlope])};
}

void incline_path(
    const Eigen::VectorXd& x, double t0, std::span<const double> t, std::span<Eigen::Vector3d> p
) {
    const Eigen::Vector3d start = x.head<3>();
    const Eigen::Vector3d down = incline_direction(x);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double tau = t[i] - t0;
        const double y = x[kInclineDrag] * tau;
        double by_v = tau * (1.0 - y / 2 * (1.0 - y / 3 * (1.0 - y / 4)));
        double by_a = tau * tau * (0.5 - y / 6 * (1.0 - y / 4 * (1.0 - y / 5)));
        if (std::abs(y) > 1e-3) {  // where the series would end too early
            by_v = -std::expm1(-y) / y * tau;
            by_a = (tau - by_v) / y * tau;
        }
        p[i] = start + (x[kInclineV] * by_v + x[kInclineA] * by_a) * down;
    }
}

}  // namespace kinectlab
