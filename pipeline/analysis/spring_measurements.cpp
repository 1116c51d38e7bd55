#include "pipeline/analysis/spring_measurements.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/path_budget.hpp"
#include "pipeline/analysis/spring_model.hpp"

namespace kinectlab {
namespace {

using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kHeaviestSpring = 0.1;      // of the load, where the spring was not weighed
constexpr double kSpringMassFactorU = 0.01;  // of 1/3: 4/π² without any load

double omega(const VectorXd& x) {
    return x[kSpringOmega];
}

double free_amplitude(const VectorXd& x) {
    return std::hypot(x[kSpringCos], x[kSpringSin]);
}

double resonance(const VectorXd& x) {
    const double square = omega(x) * omega(x) - 2.0 * x[kSpringDamping] * x[kSpringDamping];
    return std::sqrt(square) / (2.0 * pi);
}

double phase_lag(const VectorXd& x) {
    const double drive = x[kSpringDriveOmega];
    return std::atan2(2.0 * x[kSpringDamping] * drive, omega(x) * omega(x) - drive * drive);
}

void add_stiffness(
    AnalysisOutcome& out, const PathBudget& budget, const PathFit& fit, const AnalysisSettings& s
) {
    const auto mass = s.find("mass_kg");
    if (mass == s.end()) {
        out.notes.emplace_back("The mass was not given: the stiffness is left out.");
        return;
    }
    const auto spring = s.find("spring_mass_kg");
    const bool weighed = spring != s.end();
    const double moved = mass->second + (weighed ? spring->second / 3.0 : 0.0);
    const double square = std::pow(omega(fit.parameters), 2);
    if (!weighed)
        out.notes.push_back(fmt::format(
            "spring_mass_kg was not given: the third of it that swings along is not corrected for, "
            "and a spring of up to {:.0f} % of the mass is in the budget.",
            100.0 * kHeaviestSpring
        ));
    // Not weighed: all from zero to the bound alike likely, and taken as zero.
    const double along_u = weighed ? spring->second * kSpringMassFactorU
                                   : mass->second * kHeaviestSpring / 3.0 / std::sqrt(3.0);
    out.measurements.push_back(budget.measure(
        "stiffness",
        "N/m",
        [=](const VectorXd& x) { return moved * omega(x) * omega(x); },
        {0, -2},
        {{"mass", square * s.at("mass_u_kg")}, {"spring mass", square * along_u}}
    ));
}

void tell_drag_law(AnalysisOutcome& out, const Measurement& linear, const Measurement& quadratic) {
    const bool by_speed = linear.value > 3.0 * linear.u;
    const bool by_square = quadratic.value > 3.0 * quadratic.u;
    if (by_speed && !by_square)
        out.notes.emplace_back(
            "The amplitude falls as with a drag in proportion to the speed; one of its square does "
            "not show."
        );
    else if (by_square && !by_speed)
        out.notes.emplace_back(
            "The amplitude falls as with a drag of the speed's square; one in proportion to the "
            "speed does not show."
        );
    else if (by_square)
        out.notes.emplace_back("Both drags show: in proportion to the speed and to its square.");
    else
        out.notes.emplace_back(
            "Whether the drag grows with the speed or with its square does not show in this run; "
            "the damping takes in both."
        );
}

void add_free(AnalysisOutcome& out, const PathBudget& budget, bool metric, double prior_u) {
    const Measurement quadratic = budget.measure(
        "quadratic_drag", "1/m", [](const VectorXd& x) { return x[kSpringQuadratic]; }, {-1, 0}
    );
    const Measurement damping = budget.measure(
        "damping", "1/s", [](const VectorXd& x) { return x[kSpringDamping]; }, {0, -1}
    );
    tell_drag_law(out, damping, quadratic);
    if (metric && quadratic.u < 0.5 * prior_u) out.measurements.push_back(quadratic);
    if (metric)
        out.measurements.push_back(budget.measure("amplitude", "m", free_amplitude, {1, 0}));
}

void add_driven(AnalysisOutcome& out, const PathBudget& budget, bool metric, bool resonance_known) {
    if (metric)
        out.measurements.push_back(budget.measure(
            "steady_amplitude",
            "m",
            [](const VectorXd& x) { return std::hypot(x[kSpringDriveCos], x[kSpringDriveSin]); },
            {1, 0}
        ));
    const Measurement lag = budget.measure("phase_lag", "rad", phase_lag, {});
    if (resonance_known && lag.u < 0.3)
        out.measurements.push_back(lag);
    else
        out.notes.emplace_back(
            "How far the mass lags behind the drive follows from resonance and damping, which this "
            "run does not tell: record from the start of the drive on."
        );
}

}  // namespace

void spring_measurements(
    AnalysisOutcome& out,
    const PathFit& fit,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions,
    double length
) {
    const bool driven = settings.at("drive_hz") > 0.0;
    std::vector<PriorLine> priors;
    if (driven)
        priors = {{"drive", {kSpringDriveOmega}}, {"prior", {kSpringOmega, kSpringDamping}}};
    else
        priors = {{"model choice", {kSpringQuadratic}}};
    const PathBudget budget(fit, priors, conditions);
    const Measurement frequency = budget.measure("angular_frequency", "rad/s", omega, {0, -1});
    const Measurement damping = budget.measure(
        "damping", "1/s", [](const VectorXd& x) { return x[kSpringDamping]; }, {0, -1}
    );
    const Measurement free = budget.measure("", "", free_amplitude, {1, 0});
    // A sine that noise makes has about three times its own uncertainty.
    const bool known = frequency.u < 0.03 * frequency.value && free.value > 6.0 * free.u;
    if (known) {
        out.measurements.push_back(budget.measure(
            "period", "s", [](const VectorXd& x) { return 2.0 * pi / damped_omega(x); }, {0, 1}
        ));
        out.measurements.push_back(frequency);
        add_stiffness(out, budget, fit, settings);
        out.measurements.push_back(budget.measure("resonance_frequency", "Hz", resonance, {0, -1}));
        out.measurements.push_back(damping);
        if (damping.value > 4.0 * damping.u)
            out.measurements.push_back(budget.measure(
                "quality_factor",
                "1",
                [](const VectorXd& x) { return omega(x) / (2.0 * x[kSpringDamping]); },
                {}
            ));
        else
            out.notes.emplace_back(
                "The damping is not told apart from zero: the quality factor is left out."
            );
    } else {
        out.notes.emplace_back(
            "The oscillation of the spring itself had died away: its period, stiffness and damping "
            "are not told by the steady answer to the drive."
        );
    }
    if (driven)
        add_driven(out, budget, conditions.metric, known);
    else
        add_free(out, budget, conditions.metric, kSpringQuadraticUnknown / length);
}

}  // namespace kinectlab
