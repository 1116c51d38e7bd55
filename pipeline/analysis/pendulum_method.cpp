#include <cmath>

#include <Eigen/Eigenvalues>

#include "pipeline/analysis/methods.hpp"
#include "pipeline/analysis/object_plots.hpp"
#include "pipeline/analysis/pendulum.hpp"

namespace kinectlab {
namespace {

using Eigen::Vector3d;

PendulumSettings to_pendulum(const AnalysisSettings& s, const AnalysisConditions& conditions) {
    const auto given = [&](const char* name) -> std::optional<double> {
        const auto found = s.find(name);
        return found == s.end() ? std::nullopt : std::optional(found->second);
    };
    PendulumSettings settings;
    settings.length_m = given("length_m");
    settings.length_u_m = s.at("length_u_m");
    settings.body = {
        given("bob_radius_m"),
        given("bob_density_kg_m3"),
        given("air_density_kg_m3"),
        given("string_mass_kg")};
    settings.tilt_u_rad = conditions.tilt_u_rad;
    settings.metric = conditions.metric;
    settings.latitude_deg = s.at("latitude_deg");
    settings.depth_scale_u = conditions.depth_scale_u;
    settings.clock_u = conditions.clock_u;
    settings.on_earth = conditions.on_earth;
    return settings;
}

struct SwingAxes {
    Vector3d centre = Vector3d::Zero();
    Vector3d along = Vector3d::UnitX();  ///< horizontal, where the bob moves most
    Vector3d across = Vector3d::UnitY();
};

/// Where the fitted bob moves to and fro.
SwingAxes swing_axes(const ObjectFit& fit) {
    SwingAxes axes;
    double n = 0.0;
    for (const auto& p : fit.fit_lab)
        if (p.allFinite()) {
            axes.centre += p;
            n += 1.0;
        }
    axes.centre /= n;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const auto& p : fit.fit_lab)
        if (p.allFinite()) {
            const Eigen::Vector2d d = (p - axes.centre).head<2>();
            spread += d * d.transpose();
        }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(spread);
    Eigen::Vector2d main = eigen.eigenvectors().col(1);
    if (main.cwiseAbs().maxCoeff() == -main.minCoeff()) main = -main;  // points along +x or +y
    axes.along = {main.x(), main.y(), 0.0};
    axes.across = Vector3d::UnitZ().cross(axes.along);
    return axes;
}

Result<AnalysisOutcome> run(
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
) {
    auto result = analyse_pendulum(objects.front(), to_pendulum(settings, conditions));
    if (!result) return tl::unexpected(result.error());
    AnalysisOutcome outcome;
    const SwingAxes axes = swing_axes(result->fit);
    outcome.plots = {
        position_plot(result->fit, axes.centre, axes.along),
        residual_plot(result->fit),
        phase_plot(result->fit, objects.front(), axes.centre, axes.along),
        path_plot(result->fit, axes.centre, axes.along, axes.across, "x", "y")};
    outcome.measurements = std::move(result->measurements);
    for (const auto& m : outcome.measurements)
        if (m.name == "period") {
            TimeNs first = 0;
            TimeNs last = 0;
            for (std::size_t i = 0; i < result->fit.t.size(); ++i) {
                if (!result->fit.fit_lab[i].allFinite()) continue;
                if (first == 0) first = result->fit.t[i];
                last = result->fit.t[i];
            }
            outcome.facts["periods"] = to_seconds(last - first) / m.value;
        }
    outcome.warnings = std::move(result->warnings);
    outcome.fits.push_back(std::move(result->fit));
    return outcome;
}

}  // namespace

AnalysisMethod pendulum_method() {
    AnalysisMethod method;
    method.name = "pendulum";
    method.settings = {
        {"length_m", 0.05, 100.0, {}, "From the pivot to the centre of the bob.", true},
        {"length_u_m", 0.0, 10.0, 0.0005, "Standard uncertainty of the length."},
        {"bob_radius_m", 0.0, 10.0, 0.0, "Of a solid ball that turns with the string."},
        {"latitude_deg", -90.0, 90.0, 45.0, "Of the rig, north positive."}};
    method.results = {
        "g",
        "period",
        "small_angle_period",
        "amplitude",
        "damping",
        "quality_factor",
        "turning_rate"};
    method.plots = {"position", "residuals", "phase", "path"};
    method.facts = {"periods"};
    method.run = run;
    return method;
}

}  // namespace kinectlab
