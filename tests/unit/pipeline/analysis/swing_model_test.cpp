#include "pipeline/analysis/swing_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/analysis/swing_fit.hpp"

namespace kinectlab {
namespace {

SwingParameters wide_ellipse() {
    SwingParameters p;
    p.pivot = {0.1, 1.5, 1.2};
    p.radius = 0.9;
    p.n = Eigen::Vector3d(0.5, 0.1, -0.8).normalized();
    p.v = tangent_axes(p.n) * Eigen::Vector2d(0.4, -0.9);
    p.omega0_sq = 10.5;
    p.tilt = {0.01, -0.02};
    p.damping = 0.03;
    p.quadratic = 0.2;
    p.turning = 0.05;
    return p;
}

TEST(SwingModel, JacobianIsThatOfThePath) {
    for (const double t : {0.0, 0.7, 9.3, -2.1}) {
        SwingPath path(wide_ellipse());
        path.go_to(t);
        const SwingJacobian jacobian = path.jacobian();
        for (int i = 0; i < kSwingParameters; ++i) {
            SwingVector step = SwingVector::Zero();
            step[i] = 1e-6;
            SwingPath more(moved(wide_ellipse(), step));
            SwingPath less(moved(wide_ellipse(), -step));
            more.go_to(t);
            less.go_to(t);
            const Eigen::Vector3d slope = (more.position() - less.position()) / 2e-6;
            EXPECT_LT((slope - jacobian.col(i)).norm(), 1e-6 * (1.0 + slope.norm()))
                << "parameter " << i << " at " << t;
        }
    }
}

TEST(SwingModel, GoesBackTheWayItCame) {
    SwingPath there(wide_ellipse());
    there.go_to(5.0);
    SwingPath back(there.now());
    back.go_to(-5.0);
    EXPECT_LT((back.now().n - wide_ellipse().n).norm(), 5e-7);
    EXPECT_LT((back.now().v - wide_ellipse().v).norm(), 1e-6);
}

TEST(SwingModel, PeriodFactorFollowsItsSeries) {
    for (const double theta : {0.0, 0.05, 0.17, 0.35, 0.52}) {
        const double t2 = theta * theta;
        const double series = 1.0 + t2 / 16 + 11 * t2 * t2 / 3072 + 173 * t2 * t2 * t2 / 737280;
        EXPECT_NEAR(period_factor(theta), series, 2e-6 * std::pow(theta / 0.52, 8) + 1e-15);
    }
}

TEST(SwingModel, TurningAngleIsTheWidestOfThePath) {
    SwingParameters p = wide_ellipse();
    p.damping = 0.0;
    p.quadratic = 0.0;
    p.turning = 0.0;
    SwingPath path(p);
    double widest = 0.0;
    for (double t = 0.0; t < 4.0; t += 1e-3) {
        path.go_to(t);
        widest = std::max(widest, std::acos(path.now().n.dot(p.down())));
    }
    EXPECT_NEAR(turning_angle(p), widest, 1e-6);
}

TEST(SwingModel, EnergyAngleOfAPlaneSwingIsItsAmplitude) {
    SwingParameters p;
    p.n = {std::sin(0.4), 0.0, -std::cos(0.4)};
    EXPECT_NEAR(energy_angle(p), 0.4, 1e-12);
    EXPECT_NEAR(turning_angle(p), 0.4, 1e-9);
}

}  // namespace
}  // namespace kinectlab
