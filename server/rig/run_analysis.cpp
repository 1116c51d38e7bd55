#include "server/rig/run_analysis.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/core/version.hpp"
#include "pipeline/motion/motion.hpp"
#include "server/experiments/preprocess_json.hpp"
#include "server/experiments/result_json.hpp"
#include "server/lab/utc.hpp"
#include "server/rig/observer.hpp"

namespace kinectlab::rig {
namespace {

using nlohmann::json;

double parameter(const lab::Run& run, const char* name, double otherwise) {
    const auto found = run.parameters.find(name);
    return found == run.parameters.end() ? otherwise : found->second;
}

/// What somebody needs to come to the same numbers again. A simulated rig's source carries its
/// seed: sim://rig-1?seed=1.
experiments::Provenance provenance(
    const RunMeasured& measured, const Trajectory& trajectory, const ObjectFit& fit
) {
    const auto& samples = trajectory.samples;
    const auto tracked = std::count_if(samples.begin(), samples.end(), [](const auto& sample) {
        return sample.status == TrackStatus::tracked;
    });
    return {
        .program_version = kVersion,
        .source = measured.source.name,
        .camera = measured.source.camera,
        .T_lab_cam = measured.source.T_lab_cam.value_or(level_camera()),
        .lab_frame_assumed = !measured.source.T_lab_cam.has_value(),
        .first_frame = samples.front().t,
        .last_frame = samples.back().t,
        .frames = static_cast<std::size_t>(measured.run.frames),
        .frames_tracked = static_cast<std::size_t>(tracked),
        .samples_used = static_cast<std::size_t>(fit.used),
        .outliers = static_cast<std::size_t>(fit.outliers),
        .reduced_chi2 = fit.reduced_chi2,
    };
}

/// How its frames were prepared, by the experiment as it was defined then.
json preprocess_of(const lab::Run& run) {
    const json definition = json::parse(run.definition_json, nullptr, false);
    const bool told = definition.is_object() && definition.contains("preprocess");
    const auto settings = told
                              ? experiments::read_preprocess(definition["preprocess"], "preprocess")
                              : Result<PreprocessSettings>();
    return experiments::to_json(settings.value_or(PreprocessSettings{}));
}

/// What only a run on a rig has.
void add_run(json& provenance, const lab::Run& run) {
    provenance["rig"] = run.rig;
    provenance["run"] = run.id;
    provenance["started"] = lab::to_rfc3339(run.started.value_or(run.created));
    provenance["frames_lost"] = run.frames_lost;
    provenance["configuration"] = preprocess_of(run);
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

json fit_json(const ObjectFit& fit, TimeNs started) {
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
    if (trajectories.empty() || trajectories.front().samples.empty()) {
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
            // Only a simulated rig has it as a parameter.
            .on_earth = is_earthly(parameter(run, "gravity", kLeastOnEarth)),
        }
    );
    if (!result) return tl::unexpected(result.error());

    RunAnalysis analysis;
    analysis.warnings = result->warnings;
    if (!measured.source.T_lab_cam) {
        analysis.warnings.emplace_back(
            "The camera's place is not calibrated: it was taken to look level along y."
        );
    }
    json document = experiments::result_to_json(
        run.experiment,
        run.parameters,
        result->measurements,
        analysis.warnings,
        provenance(measured, trajectories.front(), result->fit)
    );
    add_run(document["provenance"], run);
    analysis.result_json = document.dump();
    analysis.fit_json = fit_json(result->fit, run.started.value_or(run.created)).dump();
    return analysis;
}

}  // namespace kinectlab::rig
