#include "server/rig/run_analysis.hpp"

#include <nlohmann/json.hpp>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/core/version.hpp"
#include "pipeline/motion/motion.hpp"
#include "pipeline/run/chain.hpp"
#include "server/lab/utc.hpp"
#include "server/rig/observer.hpp"

namespace kinectlab::rig {
namespace {

using nlohmann::json;

double parameter(const lab::Run& run, const char* name, double otherwise) {
    const auto found = run.parameters.find(name);
    return found == run.parameters.end() ? otherwise : found->second;
}

json pinhole_json(const Pinhole& camera) {
    return {
        {"width", camera.width},
        {"height", camera.height},
        {"fx", camera.fx},
        {"fy", camera.fy},
        {"cx", camera.cx},
        {"cy", camera.cy}};
}

json transform_json(const Eigen::Isometry3d& transform) {
    json rows = json::array();
    for (int row = 0; row < 3; ++row) {
        rows.push_back({transform(row, 0), transform(row, 1), transform(row, 2), transform(row, 3)}
        );
    }
    return rows;
}

/// What somebody needs to come to the same numbers again.
json provenance(const RunMeasured& measured) {
    const RgbdCamera& camera = measured.source.camera;
    const ChainSettings chain;
    return {
        {"program", "kinectlab"},
        {"version", kVersion},
        {"run", measured.run.id},
        {"rig", measured.run.rig},
        {"started", lab::to_rfc3339(measured.run.started.value_or(measured.run.created))},
        // A simulated rig's name carries its seed: sim://rig-1?seed=1.
        {"source", measured.source.name},
        {"frames", measured.run.frames},
        {"frames_lost", measured.run.frames_lost},
        {"configuration",
         {{"change_threshold_steps", chain.change_threshold_steps},
          {"min_segment_points", chain.min_segment_points}}},
        {"calibration",
         {{"depth", pinhole_json(camera.depth)},
          {"depth_unit_m", camera.depth_unit_m},
          {"depth_scale_u", camera.depth_scale_u},
          {"clock_u", camera.clock_u},
          {"inverse_depth_step_per_m", camera.noise.inverse_depth_step},
          {"sigma_steps", camera.noise.sigma_steps},
          {"T_lab_cam", transform_json(measured.source.T_lab_cam.value_or(level_camera()))},
          {"T_lab_cam_from", measured.source.T_lab_cam ? "device" : "assumed level"}}},
    };
}

json measurement_json(const Measurement& measurement) {
    json budget = json::array();
    for (const BudgetLine& line : measurement.budget) {
        budget.push_back({{"source", line.source}, {"u", line.u}});
    }
    return {
        {"name", measurement.name},
        {"value", measurement.value},
        {"u", measurement.u},
        {"unit", measurement.unit},
        {"k", 1},
        {"budget", budget}};
}

/// {"x": […], "y": […], "z": […]}; NaN becomes null.
json columns(const std::vector<Eigen::Vector3d>& points) {
    json axes = {{"x", json::array()}, {"y", json::array()}, {"z", json::array()}};
    for (const Eigen::Vector3d& point : points) {
        axes["x"].push_back(point.x());
        axes["y"].push_back(point.y());
        axes["z"].push_back(point.z());
    }
    return axes;
}

json fit_json(const PendulumFit& fit, TimeNs started) {
    json t_s = json::array();
    for (const TimeNs t : fit.t)
        t_s.push_back(to_seconds(t - started));
    return {
        {"t_s", t_s},
        {"measured", columns(fit.p_lab)},
        {"fit", columns(fit.fit_lab)},
        {"residual", columns(fit.residual)},
        {"used", fit.used},
        {"outliers", fit.outliers},
        {"reduced_chi2", fit.reduced_chi2}};
}

}  // namespace

std::vector<Trajectory> final_trajectories(const RunMeasured& measured) {
    const SourceInfo& source = measured.source;
    std::vector<Trajectory> trajectories;
    for (const auto& [object, samples] : measured.samples) {
        trajectories.push_back(to_trajectory(
            object,
            samples,
            source.T_lab_cam.value_or(level_camera()),
            {.frame_period_s = 1.0 / source.frame_rate_hz}
        ));
    }
    return trajectories;
}

Result<RunAnalysis> analyse_run(
    const RunMeasured& measured, const std::vector<Trajectory>& trajectories
) {
    const lab::Run& run = measured.run;
    if (run.experiment != "pendulum") {
        return fail(
            ErrorCode::not_found, "experiment", "\"" + run.experiment + "\" has no analysis"
        );
    }
    if (trajectories.empty()) {
        return fail(ErrorCode::bad_data, "", "nothing was measured", "measure for longer");
    }
    const RgbdCamera& camera = measured.source.camera;
    const PendulumSettings defaults;
    const auto result = analyse_pendulum(
        trajectories.front(),
        {
            .length_m = parameter(run, "length_m", defaults.length_m),
            .length_u_m = parameter(run, "length_u_m", defaults.length_u_m),
            .bob_radius_m = parameter(run, "bob_radius_m", defaults.bob_radius_m),
            .latitude_deg = parameter(run, "latitude_deg", defaults.latitude_deg),
            .depth_scale_u = camera.depth_scale_u,
            .clock_u = camera.clock_u,
        }
    );
    if (!result) return tl::unexpected(result.error());

    json results = json::array();
    for (const Measurement& measurement : result->measurements) {
        results.push_back(measurement_json(measurement));
    }
    RunAnalysis analysis;
    analysis.result_json = json{
        {"experiment", run.experiment},
        {"parameters", run.parameters},
        {"results", results},
        {"provenance",
         provenance(measured)}}.dump();
    analysis.fit_json = fit_json(result->fit, run.started.value_or(run.created)).dump();
    analysis.warnings = result->warnings;
    if (!measured.source.T_lab_cam) {
        analysis.warnings.emplace_back(
            "The camera's place is not calibrated: it was taken to look level along y."
        );
    }
    return analysis;
}

}  // namespace kinectlab::rig
