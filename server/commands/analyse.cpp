#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/analysis/pendulum.hpp"
#include "server/commands/arguments.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/fit_csv.hpp"
#include "server/commands/output.hpp"
#include "server/commands/pose_table.hpp"
#include "server/commands/tracked_recording.hpp"
#include "server/config/share.hpp"
#include "server/config/version.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/recorded_settings.hpp"
#include "server/experiments/result_json.hpp"

namespace kinectlab::commands {
namespace {

using experiments::Values;

struct Arguments {
    std::string experiment;
    std::string recording;
    std::string out;
    std::vector<std::string> settings;
};

std::optional<int> parse(int argc, char** argv, Arguments& arguments) {
    CLI::App app(
        "Measures with a recording of an experiment: poses, motion, results with their "
        "uncertainties, as JSON on stdout.",
        "kinectlab analyse"
    );
    app.add_option("EXPERIMENT", arguments.experiment, "what was recorded, e.g. pendulum")
        ->required();
    app.add_option("RECORDING", arguments.recording, "folder in the TUM layout, .pcd or .oni")
        ->required();
    app.add_option(
           "--set",
           arguments.settings,
           "a parameter, NAME=VALUE; may be repeated. Goes before what the recording's own "
           "experiment.json says, and that before the default"
    )
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--out", arguments.out, "folder for result.json, poses.csv and fit.csv")
        ->check(check_path);
    return parse_arguments(app, argc, argv);
}

bool on_earth(const Values& truth) {
    const auto gravity = truth.find("gravity");
    return gravity == truth.end() || is_earthly(gravity->second);
}

PendulumSettings pendulum_settings(const Values& values, const RgbdCamera& camera) {
    PendulumSettings settings;
    settings.length_m = values.at("length_m");
    settings.length_u_m = values.at("length_u_m");
    settings.bob_radius_m = values.at("bob_radius_m");
    settings.latitude_deg = values.at("latitude_deg");
    settings.depth_scale_u = camera.depth_scale_u;
    settings.clock_u = camera.clock_u;
    return settings;
}

experiments::Provenance provenance_of(
    const TrackedRecording& recording, const Trajectory& trajectory, const PendulumFit& fit
) {
    experiments::Provenance p;
    p.program_version = config::version();
    p.source = recording.source.name;
    p.camera = recording.source.camera;
    p.T_lab_cam = lab_pose_of(recording.source);
    p.lab_frame_assumed = !recording.source.T_lab_cam.has_value();
    p.first_frame = recording.frames.front();
    p.last_frame = recording.frames.back();
    p.frames = recording.frames.size();
    for (const auto& sample : trajectory.samples)
        p.frames_tracked += sample.status == TrackStatus::tracked ? 1 : 0;
    p.samples_used = static_cast<std::size_t>(fit.used);
    p.outliers = static_cast<std::size_t>(fit.outliers);
    p.reduced_chi2 = fit.reduced_chi2;
    return p;
}

Result<void> write_files(
    const std::filesystem::path& folder,
    const nlohmann::json& result,
    const std::vector<Trajectory>& trajectories,
    const PendulumFit& fit
) {
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code)
        return fail(
            ErrorCode::unavailable,
            folder.string(),
            "cannot be made: " + code.message(),
            "name a folder that you may write to"
        );
    return write_text_file(folder / "poses.csv", poses_to_csv(trajectories))
        .and_then([&] { return write_text_file(folder / "fit.csv", fit_to_csv(fit)); })
        .and_then([&] { return write_text_file(folder / "result.json", result.dump(1) + "\n"); });
}

}  // namespace

int analyse(int argc, char** argv) {
    Arguments arguments;
    if (const auto status = parse(argc, argv, arguments)) return *status;
    const auto definition =
        experiments::load_definition(config::share_dir() / "experiments", arguments.experiment);
    if (!definition) return report_usage(definition.error());
    const auto given = parse_settings(arguments.settings);
    if (!given) return report_usage(given.error());
    // What was given is checked before a long recording is read.
    const auto checked = experiments::validate(*definition, *given, experiments::RigKind::real);
    if (!checked) return report_usage(checked.error());
    const auto values =
        experiments::with_recorded_settings(*definition, *given, arguments.recording);
    if (!values) return report(values.error());

    const auto recording =
        track_recording(arguments.recording, experiments::plan_for(*definition, *values));
    if (!recording) return report(recording.error());
    const auto trajectories = trajectories_of(*recording);
    PendulumSettings settings = pendulum_settings(*values, recording->source.camera);
    settings.on_earth = on_earth(experiments::recorded_truth(*definition, arguments.recording));
    const auto measured = analyse_pendulum(trajectories.front(), settings);
    if (!measured) {
        static_cast<void>(report(measured.error()));
        return kFailed;
    }
    const auto result = experiments::result_to_json(
        definition->id,
        *values,
        measured->measurements,
        measured->warnings,
        provenance_of(*recording, trajectories.front(), measured->fit)
    );
    if (!arguments.out.empty()) {
        auto written = write_files(arguments.out, result, trajectories, measured->fit);
        if (!written) return report(written.error());
    }
    print_json(result);
    return kOk;
}

}  // namespace kinectlab::commands
