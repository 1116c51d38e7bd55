#include "tests/bench/swing_truth.hpp"

#include <cmath>
#include <numbers>

#include "pipeline/analysis/swing_measurements.hpp"

namespace kinectlab::bench {
namespace {

using std::numbers::pi;

/// Of an undamped orbit that is released at its widest, over the length: what energy and angular
/// momentum leave.
double half_width_of(const SwingParameters& p) {
    const double l = p.n.x() * p.v.y();
    const double energy = 0.5 * p.v.squaredNorm() + p.omega0_sq * p.n.z();
    double square = 0.0;
    for (int i = 0; i < 50; ++i)
        square = l * l / (2.0 * (energy + p.omega0_sq * std::sqrt(1.0 - square)));
    return std::copysign(std::sqrt(square), l);
}

}  // namespace

std::map<std::string, double> truth_of(const PositionRun& run) {
    const SwingParameters p = true_parameters(run);
    const double duration = run.swing.seconds - 1.0 / run.swing.rate;
    const double rms = mean_amplitude(p, duration);
    const double omega0 = std::sqrt(p.omega0_sq);
    const double stretch = period_factor(rms);
    const double falls = p.damping + 4.0 / (3.0 * pi) * p.quadratic * omega0 * rms;
    std::map<std::string, double> truth{
        {"g", run.swing.g},
        {"small_angle_period", 2.0 * pi / omega0},
        {"period", 2.0 * pi / std::sqrt(p.omega0_sq / (stretch * stretch) - p.damping * p.damping)},
        {"amplitude", turning_angle(p)},
        {"damping", p.damping},
        {"quadratic_damping", p.quadratic},
        {"quality_factor", omega0 / (2.0 * falls)},
        {"turning_rate", earth_turning(run.swing.latitude_deg)},
        {"precession_rate", earth_turning(run.swing.latitude_deg)},
        {"latitude", run.swing.latitude_deg},
        {"ellipse_a", run.swing.length * std::sin(turning_angle(p))}};
    truth["ellipse_b"] = run.swing.length * half_width_of(p);
    return truth;
}

}  // namespace kinectlab::bench
