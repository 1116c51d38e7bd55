#include "tests/bench/frame_truth.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/bench/swing_truth.hpp"

namespace kinectlab::bench {
namespace {

using Eigen::Vector3d;
using experiments::Values;
using simulate::Truth;
using std::numbers::pi;
using Results = std::map<std::string, double>;

constexpr double kFrame = 1.0 / simulate::kFrameRateHz;

std::size_t first_used(const AnalysisOutcome& outcome) {
    return static_cast<std::size_t>(std::lround(outcome.facts.at("start_s") / kFrame));
}

Results swing_results(const FrameExperiment& experiment) {
    const Values& v = experiment.values;
    PositionRun run;
    run.swing.g = v.at("gravity");
    run.swing.length = v.at("length_m");
    run.swing.bob_radius = v.at("bob_radius_m");
    run.swing.amplitude_deg = v.at("amplitude_deg");
    run.swing.damping = v.at("damping_per_s");
    run.swing.latitude_deg = v.at("latitude_deg");
    run.swing.seconds = experiment.seconds;
    return truth_of(run);
}

Results flight_results(const Values& v, const FrameRun& run, std::size_t first) {
    const auto body = [&](std::size_t i) {
        return run.truth.at(i).body();
    };
    const Vector3d start = body(first).v_lab;
    const double air = v.at("air_density_kg_m3") / v.at("ball_density_kg_m3");
    Results results{
        {"g", v.at("gravity")},
        {"launch_speed", start.norm()},
        {"elevation", std::atan2(start.z(), start.head<2>().norm())},
        {"drag",
         0.375 * v.at("drag_coefficient") * air / v.at("ball_radius_m") / (1.0 + air / 2.0)}};
    if (start.z() <= 0.0) return results;
    std::size_t i = first;
    while (body(i + 1).v_lab.z() > 0.0)
        ++i;
    const double up = body(i).v_lab.z();
    const double left = kFrame * up / (up - body(i + 1).v_lab.z());
    results["time_to_top"] = kFrame * static_cast<double>(i - first) + left;
    results["rise"] = body(i).p_lab.z() + up * left / 2.0 - body(first).p_lab.z();
    return results;
}

Results slope_results(const Values& v) {
    const double angle = v.at("incline_deg") * pi / 180.0;
    const double rolling = 5.0 / 7.0 * v.at("gravity") * std::sin(angle);
    return {{"acceleration", rolling}, {"angle", angle}, {"g", v.at("gravity")}, {"drag", 0.0}};
}

Results spring_results(const Values& v, const Truth& start) {
    const double square = v.at("stiffness_n_m") / v.at("mass_kg");
    const double damping = v.at("damping_per_s");
    const double damped = std::sqrt(square - damping * damping);
    const double x = -start.value;
    return {
        {"period", 2.0 * pi / damped},
        {"angular_frequency", std::sqrt(square)},
        {"stiffness", v.at("stiffness_n_m")},
        {"damping", damping},
        {"quadratic_drag", 0.0},
        {"quality_factor", std::sqrt(square) / (2.0 * damping)},
        {"resonance_frequency", std::sqrt(square - 2.0 * damping * damping) / (2.0 * pi)},
        {"amplitude", std::hypot(x, (start.body().v_lab.z() + damping * x) / damped)}};
}

/// Where the straight lines before and after it cross, s after the first frame.
double impact_time(const FrameRun& run, std::size_t after) {
    const simulate::Body& from = run.truth.front().body();
    const simulate::Body& to = run.truth.at(after).body();
    const Vector3d change = from.v_lab - to.v_lab;
    const Vector3d apart = to.p_lab - from.p_lab - kFrame * static_cast<double>(after) * to.v_lab;
    return apart.dot(change) / change.squaredNorm();
}

Results collision_results(const Values& v, const FrameRun& run) {
    const auto& before = run.truth.front().bodies;
    std::size_t i = 0;
    while (run.truth.at(i).body().v_lab == before[0].v_lab)
        ++i;
    const auto& after = run.truth[i].bodies;
    const double a = v.at("mass_a_kg");
    const double b = v.at("mass_b_kg");
    const Vector3d along = (before[0].v_lab - before[1].v_lab).normalized();
    const auto momentum = [&](const auto& bodies) {
        return (a * bodies[0].v_lab + b * bodies[1].v_lab).dot(along);
    };
    const auto energy = [&](const auto& bodies) {
        return 0.5 * (a * bodies[0].v_lab.squaredNorm() + b * bodies[1].v_lab.squaredNorm());
    };
    return {
        {"speed_a_before", before[0].v_lab.norm()},
        {"speed_b_before", before[1].v_lab.norm()},
        {"speed_a_after", after[0].v_lab.norm()},
        {"speed_b_after", after[1].v_lab.norm()},
        {"momentum_before", momentum(before)},
        {"momentum_after", momentum(after)},
        {"momentum_balance", 0.0},
        {"momentum_balance_across", 0.0},
        {"energy_before", energy(before)},
        {"energy_after", energy(after)},
        {"energy_lost_share", 1.0 - energy(after) / energy(before)},
        {"restitution", v.at("restitution")},
        {"impact_time", impact_time(run, i)}};
}

/// The robot's own drive from the first frame to the last, in small steps: it turns corners
/// between frames.
Results drive_results(const FrameExperiment& experiment) {
    const auto run = run_settings_of(experiment);
    const auto robot = simulate::make_apparatus(run.rig.apparatus);
    if (!robot) throw std::runtime_error(to_text(robot.error()));
    double now = 0.0;
    static_cast<void>((*robot)->apply({simulate::Action::displace, 0.0}));
    while ((*robot)->motion() != simulate::Motion::held)
        (*robot)->advance_to(now += 1.0);
    static_cast<void>((*robot)->apply({simulate::Action::release, 0.0}));
    (*robot)->advance_to(now += kFrame);
    const Vector3d from = (*robot)->bodies().front().p_lab;
    constexpr int kParts = 100;  // of a frame
    const double step = kFrame / kParts;
    const auto steps = kParts * (std::lround(experiment.seconds / kFrame) - 1);
    double length = 0.0, greatest = 0.0, turn = 0.0;
    for (long i = 0; i < steps; ++i) {
        (*robot)->advance_to(now + step * (static_cast<double>(i) + 0.5));
        const simulate::Body body = (*robot)->bodies().front();
        length += step * body.v_lab.norm();
        turn += step * body.w_lab.z();
        greatest = std::max(greatest, body.v_lab.norm());
    }
    const double duration = step * static_cast<double>(steps);
    (*robot)->advance_to(now + duration);
    return {
        {"path_length", length},
        {"mean_speed", length / duration},
        {"greatest_speed", greatest},
        {"displacement", ((*robot)->bodies().front().p_lab - from).norm()},
        {"total_turn", turn},
        {"mean_turning_rate", turn / duration}};
}

Results tumbling_results(const simulate::Body& first) {
    return {
        {"rate_x", first.w_lab.x()},
        {"rate_y", first.w_lab.y()},
        {"rate_z", first.w_lab.z()},
        {"rate", first.w_lab.norm()},
        {"position_x", first.p_lab.x()},
        {"position_y", first.p_lab.y()},
        {"position_z", first.p_lab.z()},
        {"velocity_x", 0.0},
        {"velocity_y", 0.0},
        {"velocity_z", 0.0}};
}

}  // namespace

std::map<std::string, double> truth_of(
    const FrameExperiment& experiment, const FrameRun& run, const AnalysisOutcome& outcome
) {
    const std::string& method = experiment.definition.analysis.method;
    const Values& v = experiment.values;
    if (method == "pendulum" || method == "foucault") return swing_results(experiment);
    if (method == "projectile") return flight_results(v, run, first_used(outcome));
    if (method == "incline") return slope_results(v);
    if (method == "spring") return spring_results(v, run.truth.at(first_used(outcome)));
    if (method == "collision") return collision_results(v, run);
    if (method == "path") return drive_results(experiment);
    if (method == "rigid_body") return tumbling_results(run.truth.front().body());
    throw std::runtime_error("nobody knows what is true of " + method);
}

}  // namespace kinectlab::bench
