#include "tests/bench/pendulum_positions.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "pipeline/analysis/least_squares.hpp"
#include "pipeline/analysis/swing_measurements.hpp"

namespace kinectlab::bench {

PositionRun position_run(bool correlated) {
    PositionRun run;
    run.sigma = {4.2e-4, correlated ? 2.1e-3 : 4.1e-4, 4.1e-4};
    run.told = {3.5e-4, 3.0e-4, 3.5e-4};
    run.kept = correlated ? 0.5 : 0.0;
    return run;
}

Trajectory with_noise(Trajectory trajectory, const PositionRun& run, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double fresh = std::sqrt(1.0 - run.kept * run.kept);
    Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    for (auto& sample : trajectory.samples) {
        sample.p_lab += run.sigma.cwiseProduct(noise);
        sample.covariance.topLeftCorner<3, 3>() = run.told.cwiseAbs2().asDiagonal();
        const double x = normal(random);
        const double y = normal(random);
        noise = run.kept * noise + fresh * Eigen::Vector3d(x, y, normal(random));
    }
    return trajectory;
}

SwingParameters true_parameters(const PositionRun& run) {
    const testing::Swing& s = run.swing;
    const double angle = s.amplitude_deg * std::numbers::pi / 180.0;
    SwingParameters p;
    p.pivot = s.pivot;
    p.radius = s.length;
    p.n = {std::sin(angle), 0.0, -std::cos(angle)};
    p.v = {0.0, s.sideways / s.length, 0.0};
    p.omega0_sq = s.g * s.length / (s.length * s.length + 0.4 * s.bob_radius * s.bob_radius);
    p.damping = s.damping;
    p.quadratic = s.quadratic;
    p.turning = earth_turning(s.latitude_deg);
    return p;
}

double least_scatter_of_g(const PositionRun& run) {
    const SwingParameters p = true_parameters(run);
    SwingPath path(p);
    const Eigen::Matrix3d whiten = run.sigma.cwiseInverse().asDiagonal();
    const double fresh = std::sqrt(1.0 - run.kept * run.kept);
    SwingMatrix information = SwingMatrix::Zero();
    SwingJacobian before = SwingJacobian::Zero();
    const int n = static_cast<int>(std::lround(run.swing.seconds * run.swing.rate));
    for (int i = 0; i < n; ++i) {
        path.go_to(i / run.swing.rate);
        const SwingJacobian here = whiten * path.jacobian();
        const SwingJacobian news =
            i == 0 ? here : SwingJacobian((here - run.kept * before) / fresh);
        information += news.transpose() * news;
        before = here;
    }
    SwingPriors priors;
    priors.radius_sigma = 0.0;
    SwingMask free;
    free.set();
    free[kTurning] = false;
    free[kQuadratic] = run.swing.quadratic != 0.0;
    const SwingMatrix bound = inverse_information(information + prior_information(priors), free);
    return run.swing.g / p.omega0_sq * std::sqrt(bound(kOmega0Sq, kOmega0Sq));
}

}  // namespace kinectlab::bench
