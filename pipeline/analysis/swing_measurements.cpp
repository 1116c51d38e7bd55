#include "pipeline/analysis/swing_measurements.hpp"

#include <cmath>
#include <numbers>

#include "pipeline/analysis/swing_budget.hpp"

namespace kinectlab {
namespace {

using std::numbers::pi;

constexpr double kWorstTurning = 1e-2;  // rad/s: a round orbit shows no turning
constexpr double kArcShows = 0.1;       // relative uncertainty of a radius that is worth a g

double swung_period(const SwingParameters& p, double duration_s) {
    const double stretch = period_factor(mean_amplitude(p, duration_s));
    return 2.0 * pi / std::sqrt(p.omega0_sq / (stretch * stretch) - p.damping * p.damping);
}

/// The rate at which the run's mean amplitude falls, by both kinds of drag.
double falling_rate(const SwingParameters& p, double duration_s) {
    return p.damping +
           4.0 / (3.0 * pi) * p.quadratic * std::sqrt(p.omega0_sq) * mean_amplitude(p, duration_s);
}

Measurement measure_g(
    const SwingBudgets& budgets, const SwingFit& fit, const PendulumSettings& settings
) {
    const double l = settings.length_m.value_or(fit.parameters.radius);
    const PendulumCorrections corrections(settings.body, l);
    const double g = fit.parameters.omega0_sq * corrections.reduced_length(l);
    const double by_length =
        fit.parameters.omega0_sq *
        (corrections.reduced_length(l * 1.001) - corrections.reduced_length(l * 0.999)) /
        (0.002 * l);
    SwingSensitivity sensitivity{.clock = 2.0 * g};
    SwingFormula formula;
    if (settings.length_m) {
        sensitivity.length = by_length;
        formula = [&](const SwingParameters& x) {
            return x.omega0_sq * corrections.reduced_length(l);
        };
    } else {
        sensitivity.scale = by_length * l;
        formula = [&](const SwingParameters& x) {
            return x.omega0_sq * corrections.reduced_length(x.radius);
        };
    }
    Measurement m = budgets.measure("g", "m/s²", formula, sensitivity);
    for (const auto& [source, relative] : corrections.unknown())
        m.budget.push_back({source, relative * g});
    m.u = combined(m.budget);
    return m;
}

}  // namespace

std::vector<Measurement> swing_measurements(
    const SwingFit& fit, const PendulumSettings& settings, double duration_s
) {
    const SwingBudgets budgets(fit, settings);
    const SwingParameters& p = fit.parameters;
    const auto period = [&](const SwingParameters& x) {
        return swung_period(x, duration_s);
    };
    const auto small_period = [](const SwingParameters& x) {
        return 2.0 * pi / std::sqrt(x.omega0_sq);
    };
    const auto quality = [&](const SwingParameters& x) {
        return std::sqrt(x.omega0_sq) / (2.0 * falling_rate(x, duration_s));
    };
    std::vector<Measurement> all;
    if (shows_g(fit, settings)) all.push_back(measure_g(budgets, fit, settings));
    all.push_back(budgets.measure("period", "s", period, {.clock = period(p)}));
    all.push_back(
        budgets.measure("small_angle_period", "s", small_period, {.clock = small_period(p)})
    );
    all.push_back(budgets.measure("amplitude", "rad", turning_angle, {.any_drag = false}));
    // Where one number stands for all drag its name is that of the rate, under any law.
    const bool one_number = fit.drag.law == DragLaw::linear;
    const auto damping = [&](const SwingParameters& x) {
        return one_number ? falling_rate(x, duration_s) : x.damping;
    };
    if (fit.drag.law != DragLaw::quadratic)
        all.push_back(
            budgets.measure("damping", "1/s", damping, {.clock = p.damping, .any_drag = one_number})
        );
    if (fit.drag.law != DragLaw::linear)
        all.push_back(budgets.measure(
            "quadratic_damping",
            "1/rad",
            [](const SwingParameters& x) { return x.quadratic; },
            {.any_drag = false, .other_drag = fit.drag.quadratic_u_by_linear}
        ));
    if (falling_rate(p, duration_s) > 0.0)
        all.push_back(budgets.measure("quality_factor", "1", quality));
    if (fit.free_turning_u < kWorstTurning && !settings.flat) {
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

SwingPriors swing_priors(const PendulumSettings& settings, double rough_radius_m) {
    SwingPriors priors;
    priors.tilt_sigma = settings.tilt_u_rad;
    priors.radius = priors.radius_sigma = rough_radius_m;
    if (settings.length_m && settings.metric) {
        priors.radius = *settings.length_m;
        priors.radius_sigma =
            std::hypot(settings.length_u_m, *settings.length_m * settings.depth_scale_u);
    }
    return priors;
}

bool shows_g(const SwingFit& fit, const PendulumSettings& settings) {
    if (settings.length_m) return true;
    return settings.metric && fit.free_radius_u < kArcShows * fit.parameters.radius;
}

double amplitude_after(const SwingParameters& p, double t_s) {
    const double theta = energy_angle(p);
    const double x = p.damping * t_s;
    const double grown = std::abs(x) < 1e-6 ? t_s : -std::expm1(-x) / p.damping;
    const double by_speed = 4.0 / (3.0 * pi) * p.quadratic * std::sqrt(p.omega0_sq);
    return theta * std::exp(-x) / (1.0 + by_speed * theta * grown);
}

double mean_amplitude(const SwingParameters& p, double duration_s) {
    constexpr int kParts = 32;  // even: Simpson's rule
    double sum = 0.0;
    for (int i = 0; i <= kParts; ++i) {
        const double weight = i == 0 || i == kParts ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum += weight * std::pow(amplitude_after(p, duration_s * i / kParts), 2);
    }
    return std::sqrt(sum / (3.0 * kParts));
}

double earth_turning(double latitude_deg) {
    return 2.0 * pi / kSiderealDay * std::sin(latitude_deg * pi / 180.0);
}

}  // namespace kinectlab
