#include "server/rig/run_analysis.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/core/version.hpp"
#include "pipeline/motion/motion.hpp"
#include "server/experiments/evaluate.hpp"
#include "server/experiments/preprocess_json.hpp"
#include "server/lab/utc.hpp"
#include "server/rig/observer.hpp"

namespace kinectlab::rig {
namespace {

using nlohmann::json;

std::size_t tracked_in(const Trajectory& trajectory) {
    const auto& samples = trajectory.samples;
    return static_cast<std::size_t>(std::count_if(
        samples.begin(),
        samples.end(),
        [](const auto& sample) { return sample.status == TrackStatus::tracked; }
    ));
}

AnalysisConditions conditions_of(const lab::Run& run) {
    AnalysisConditions conditions;
    // Only a simulated rig has it as a parameter.
    const auto gravity = run.parameters.find("gravity");
    conditions.released = run.started;
    conditions.on_earth = gravity == run.parameters.end() || is_earthly(gravity->second);
    return conditions;
}

RunAnalysis to_analysis(const experiments::Evaluation& evaluation) {
    return {
        evaluation.result.dump(),
        evaluation.fit.dump(),
        evaluation.plots.dump(),
        evaluation.result["warnings"].get<std::vector<std::string>>()};
}

/// What somebody needs to come to the same numbers again. A simulated rig's source carries its
/// seed: sim://rig-1?seed=1.
experiments::Provenance provenance_of(
    const RunMeasured& measured, const std::vector<Trajectory>& trajectories
) {
    const auto& samples = trajectories.front().samples;
    experiments::Provenance provenance;
    provenance.program_version = kVersion;
    provenance.source = measured.source.name;
    provenance.camera = measured.source.camera;
    provenance.T_lab_cam = measured.source.T_lab_cam.value_or(level_camera());
    provenance.lab_frame_assumed = !measured.source.T_lab_cam.has_value();
    provenance.first_frame = samples.front().t;
    provenance.last_frame = samples.back().t;
    provenance.frames = static_cast<std::size_t>(measured.run.frames);
    provenance.frames_tracked = tracked_in(trajectories.front());
    return provenance;
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
    if (trajectories.empty() || trajectories.front().samples.empty()) {
        return fail(ErrorCode::bad_data, "", "nothing was measured", "measure for longer");
    }
    const auto definition =
        experiments::read_definition(json::parse(run.definition_json, nullptr, false));
    if (!definition) return tl::unexpected(definition.error());
    AnalysisConditions conditions = conditions_of(run);
    conditions.depth_scale_u = measured.source.camera.depth_scale_u;
    conditions.tilt_u_rad = measured.source.camera.tilt_u_rad;
    conditions.clock_u = measured.source.camera.clock_u;
    auto evaluation = experiments::evaluate(
        {*definition, run.parameters, trajectories, conditions, {}},
        provenance_of(measured, trajectories),
        run.started.value_or(run.created)
    );
    if (!evaluation) return tl::unexpected(evaluation.error());

    if (!measured.source.T_lab_cam) {
        evaluation->result["warnings"].push_back(
            "The camera's place is not calibrated: it was taken to look level along y."
        );
    }
    add_run(evaluation->result["provenance"], run);
    return to_analysis(*evaluation);
}

Result<RunAnalysis> analyse_again(
    const lab::Run& run,
    const std::vector<Trajectory>& poses,
    const std::string& earlier,
    const Reanalysis& wish
) {
    if (poses.empty() || poses.front().samples.empty())
        return fail(ErrorCode::bad_data, "", "nothing was measured in this run");
    const json before = json::parse(earlier, nullptr, false);
    const json known =
        before.is_object() ? before.value("provenance", json::object()) : json::object();
    const json camera = known.value("camera", json());
    AnalysisConditions conditions = conditions_of(run);
    if (camera.is_object()) {
        conditions.depth_scale_u = camera.value("depth_scale_u", conditions.depth_scale_u);
        conditions.tilt_u_rad = camera.value("tilt_u_rad", conditions.tilt_u_rad);
        conditions.clock_u = camera.value("clock_u", conditions.clock_u);
    }
    experiments::Provenance provenance;
    provenance.program_version = kVersion;
    provenance.source = known.value("source", run.rig);
    provenance.frames = static_cast<std::size_t>(run.frames);
    provenance.first_frame = poses.front().samples.front().t;
    provenance.last_frame = poses.front().samples.back().t;
    provenance.frames_tracked = tracked_in(poses.front());
    auto evaluation = experiments::evaluate(
        {wish.definition, run.parameters, poses, conditions, wish.settings},
        provenance,
        run.started.value_or(run.created)
    );
    if (!evaluation) return tl::unexpected(evaluation.error());
    json& written = evaluation->result["provenance"];
    for (const char* key : {"camera", "T_lab_cam", "lab_frame"})
        if (known.contains(key)) written[key] = known[key];
    add_run(written, run);
    written["from"] = "stored poses";
    written["analysed"] = lab::to_rfc3339(wish.at);
    written["analysed_by"] = wish.person;
    return to_analysis(*evaluation);
}

}  // namespace kinectlab::rig
