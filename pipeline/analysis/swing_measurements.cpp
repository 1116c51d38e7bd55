#include "pipeline/analysis/swing_measurements.hpp"

#include <cmath>
#include <functional>
#include <numbers>

namespace kinectlab {
namespace {

using std::numbers::pi;
using Formula = std::function<double(const SwingParameters&)>;

constexpr double kSiderealDay = 86164.09;  // s
constexpr double kWorstTurning = 1e-2;     // rad/s: a round orbit shows no turning

/// Central differences, each over a tenth of the parameter's own uncertainty.
SwingVector gradient(const Formula& formula, const SwingParameters& at, const SwingVector& sigma) {
    SwingVector g = SwingVector::Zero();
    for (int i = 0; i < kSwingParameters; ++i) {
        if (sigma[i] <= 0.0) continue;
        SwingVector step = SwingVector::Zero();
        step[i] = std::max(0.1 * sigma[i], 1e-7);
        g[i] = (formula(moved(at, step)) - formula(moved(at, -step))) / (2.0 * step[i]);
    }
    return g;
}

class Budgets {
public:
    Budgets(const SwingFit& fit, const PendulumSettings& settings)
        : fit_(fit), settings_(settings), covariance_(fit.from_noise + fit.from_tilt) {}

    /// `by_length` is the formula's own derivative by length_m, `by_clock` that by a relative error
    /// of the clock's rate.
    Measurement measure(
        std::string name,
        std::string unit,
        const Formula& formula,
        double by_clock,
        double by_length = 0.0
    ) const {
        const SwingVector sigma =
            covariance_.diagonal().cwiseMax(0.0).cwiseSqrt() + fit_.by_radius.cwiseAbs() * 1e-6;
        const SwingVector g = gradient(formula, fit_.parameters, sigma);
        const double by_radius = g.dot(fit_.by_radius);
        Measurement m{std::move(name), formula(fit_.parameters), 0.0, std::move(unit), {}};
        m.budget = {
            {"statistics", std::sqrt(std::max(g.dot(covariance_ * g), 0.0))},
            {"length", std::abs(by_length + by_radius) * settings_.length_u_m},
            {"clock", std::abs(by_clock) * settings_.clock_u},
            {"depth scale", std::abs(by_radius) * settings_.length_m * settings_.depth_scale_u},
        };
        m.u = combined(m.budget);
        return m;
    }

private:
    const SwingFit& fit_;
    const PendulumSettings& settings_;
    SwingMatrix covariance_;
};

/// Mean over the time of the squared amplitude, which falls as exp(-2γt).
double mean_square_amplitude(const SwingParameters& p, double duration_s) {
    const double x = 2.0 * p.damping * duration_s;
    const double share = std::abs(x) < 1e-6 ? 1.0 - x / 2.0 : -std::expm1(-x) / x;
    return std::pow(energy_angle(p), 2) * share;
}

double swung_period(const SwingParameters& p, double duration_s) {
    const double stretch = period_factor(std::sqrt(mean_square_amplitude(p, duration_s)));
    return 2.0 * pi / std::sqrt(p.omega0_sq / (stretch * stretch) - p.damping * p.damping);
}

}  // namespace

std::vector<Measurement> swing_measurements(
    const SwingFit& fit, const PendulumSettings& settings, double duration_s
) {
    const Budgets budgets(fit, settings);
    const SwingParameters& p = fit.parameters;
    const double l = settings.length_m;
    const double inertia =
        0.4 * settings.bob_radius_m * settings.bob_radius_m;  // of a solid sphere, for each kg
    const double reduced_length = (l * l + inertia) / l;
    const double g = p.omega0_sq * reduced_length;
    const auto period = [&](const SwingParameters& x) {
        return swung_period(x, duration_s);
    };
    const auto small_period = [](const SwingParameters& x) {
        return 2.0 * pi / std::sqrt(x.omega0_sq);
    };
    std::vector<Measurement> all;
    all.push_back(budgets.measure(
        "g",
        "m/s²",
        [&](const SwingParameters& x) { return x.omega0_sq * reduced_length; },
        2.0 * g,
        p.omega0_sq * (1.0 - inertia / (l * l))
    ));
    all.push_back(budgets.measure("period", "s", period, period(p)));
    all.push_back(budgets.measure("small_angle_period", "s", small_period, small_period(p)));
    all.push_back(budgets.measure("amplitude", "rad", turning_angle, 0.0));
    all.push_back(budgets.measure(
        "damping", "1/s", [](const SwingParameters& x) { return x.damping; }, p.damping
    ));
    if (p.damping > 0.0)
        all.push_back(budgets.measure(
            "quality_factor",
            "1",
            [](const SwingParameters& x) { return std::sqrt(x.omega0_sq) / (2.0 * x.damping); },
            0.0
        ));
    if (fit.free_turning_u < kWorstTurning) {
        Measurement turning{"turning_rate", fit.free_turning, 0.0, "rad/s", {}};
        turning.budget = {
            {"statistics", fit.free_turning_u},
            {"length", 0.0},
            {"clock", std::abs(fit.free_turning) * settings.clock_u},
            {"depth scale", 0.0},
        };
        turning.u = combined(turning.budget);
        all.push_back(std::move(turning));
    }
    return all;
}

SwingPriors swing_priors(const PendulumSettings& settings) {
    SwingPriors priors;
    priors.radius = settings.length_m;
    priors.radius_sigma =
        std::hypot(settings.length_u_m, settings.length_m * settings.depth_scale_u);
    return priors;
}

double earth_turning(double latitude_deg) {
    return 2.0 * pi / kSiderealDay * std::sin(latitude_deg * pi / 180.0);
}

}  // namespace kinectlab
