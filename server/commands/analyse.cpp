#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/analysis/pendulum.hpp"
#include "pipeline/core/file_ending.hpp"
#include "pipeline/sensor/file_bytes.hpp"
#include "server/commands/analysis_files.hpp"
#include "server/commands/arguments.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/output.hpp"
#include "server/commands/tracked_recording.hpp"
#include "server/config/version.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/evaluate.hpp"
#include "server/experiments/recorded_settings.hpp"
#include "server/experiments/share_dir.hpp"
#include "server/experiments/trajectory_table.hpp"

namespace kinectlab::commands {
namespace {

using experiments::Values;

constexpr std::size_t kMostTableBytes = 256U << 20U;
constexpr double kHandHeldTilt = 0.05;  // rad: nobody says how level a table's frame is

struct Arguments {
    std::string experiment;
    std::string recording;
    std::string out;
    std::string columns, units;
    std::vector<std::string> settings;
};

/// What an analysis starts from, wherever it came from.
struct Material {
    std::vector<Trajectory> trajectories;
    experiments::Provenance provenance;  ///< but for what the fit adds
    std::vector<std::string> warnings;   ///< of how it was read
    bool metric = true;                  ///< a table in pixels is not
};

std::optional<int> parse(int argc, char** argv, Arguments& arguments) {
    CLI::App app(
        "Measures with a recording of an experiment: poses, motion, results with their "
        "uncertainties, as JSON on stdout.",
        "kinectlab analyse"
    );
    app.add_option("EXPERIMENT", arguments.experiment, "what was recorded, e.g. pendulum")
        ->required();
    app.add_option(
           "RECORDING",
           arguments.recording,
           "folder in the TUM layout, .pcd or .oni; or a table of positions, .csv, .tsv or .txt"
    )
        ->required();
    app.add_option(
        "--columns",
        arguments.columns,
        "of a table: heads or numbers of its columns, such as t=Time,x=X,y=Y or t=1,x=2,y=3,z=4. "
        "With z it goes up, without it y does"
    );
    app.add_option(
        "--units",
        arguments.units,
        "of a table, such as cm or t=ms,x=cm,y=cm; else as its heads say, such as x (cm), else s "
        "and m. With px what needs no scale is measured"
    );
    app.add_option(
           "--set",
           arguments.settings,
           "a parameter, NAME=VALUE; may be repeated. Goes before what the recording's own "
           "experiment.json says, and that before the default"
    )
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option(
           "--out",
           arguments.out,
           "folder for result.json, poses.csv, fit.csv, the plots and report.html"
    )
        ->check(check_path);
    return parse_arguments(app, argc, argv);
}

AnalysisConditions conditions_of(const std::optional<RgbdCamera>& camera, const Values& truth) {
    AnalysisConditions conditions;
    if (camera) {
        conditions.depth_scale_u = camera->depth_scale_u;
        conditions.tilt_u_rad = camera->tilt_u_rad;
        conditions.clock_u = camera->clock_u;
    }
    const auto gravity = truth.find("gravity");
    conditions.on_earth = gravity == truth.end() || is_earthly(gravity->second);
    return conditions;
}

/// What happened before the release is no part of the measurement, as in a run on a rig.
std::vector<Trajectory> since(
    const std::vector<Trajectory>& trajectories, const std::optional<TimeNs>& release
) {
    if (!release) return trajectories;
    std::vector<Trajectory> rest;
    for (const auto& trajectory : trajectories) {
        rest.push_back({trajectory.object, {}});
        for (const auto& sample : trajectory.samples)
            if (sample.t >= *release) rest.back().samples.push_back(sample);
    }
    return rest;
}

std::size_t tracked_in(const Trajectory& trajectory) {
    std::size_t tracked = 0;
    for (const auto& sample : trajectory.samples)
        tracked += sample.status == TrackStatus::tracked ? 1 : 0;
    return tracked;
}

Result<Material> from_recording(
    const std::string& path, const experiments::Definition& definition, const Values& values
) {
    const auto recording = track_recording(path, experiments::plan_for(definition, values));
    if (!recording) return tl::unexpected(recording.error());
    Material material{trajectories_of(*recording), {}, {}};
    auto& p = material.provenance;
    p.source = recording->source.name;
    p.camera = recording->source.camera;
    p.T_lab_cam = lab_pose_of(recording->source);
    p.lab_frame_assumed = !recording->source.T_lab_cam.has_value();
    p.first_frame = recording->frames.front();
    p.last_frame = recording->frames.back();
    p.frames = recording->frames.size();
    p.frames_tracked = tracked_in(material.trajectories.front());
    return material;
}

bool is_table(const std::filesystem::path& path) {
    const auto ending = file_ending(path);
    return ending == ".csv" || ending == ".tsv" || ending == ".txt";
}

Result<Material> from_table(
    const std::filesystem::path& path,
    const experiments::TableLayout& layout,
    const std::string& object
) {
    std::vector<std::uint8_t> bytes;
    if (auto ok = read_file(path, kMostTableBytes, bytes); !ok) return tl::unexpected(ok.error());
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto table = experiments::read_trajectory_table(text, layout, path.filename().string());
    if (!table) return tl::unexpected(table.error());
    table->trajectory.object = object;
    Material material{
        {std::move(table->trajectory)}, {}, std::move(table->warnings), !table->pixels};
    const auto& samples = material.trajectories.front().samples;
    auto& p = material.provenance;
    p.source = path.filename().string();
    p.units = table->units;
    p.lab_frame_assumed = true;
    p.first_frame = samples.front().t;
    p.last_frame = samples.back().t;
    p.frames = samples.size();
    p.frames_tracked = tracked_in(material.trajectories.front());
    return material;
}

}  // namespace

int analyse(int argc, char** argv) {
    Arguments arguments;
    if (const auto status = parse(argc, argv, arguments)) return *status;
    const auto definition = experiments::load_definition(
        experiments::share_dir() / "experiments", arguments.experiment
    );
    if (!definition) return report_usage(definition.error());
    const auto given = parse_settings(arguments.settings);
    if (!given) return report_usage(given.error());
    const auto layout = experiments::parse_table_layout(arguments.columns, arguments.units);
    if (!layout) return report_usage(layout.error());
    if (!is_table(arguments.recording) && *layout != experiments::TableLayout{})
        return report_usage(
            {ErrorCode::invalid_argument,
             arguments.columns.empty() ? "--units" : "--columns",
             "says how to read a table, but " + arguments.recording + " is none",
             "leave it away, or give a .csv, .tsv or .txt file"}
        );
    const auto kind = is_table(arguments.recording) ? experiments::RigKind::elsewhere
                                                    : experiments::RigKind::real;
    // What was given is checked before a long recording is read.
    const auto checked = experiments::validate(*definition, *given, kind);
    if (!checked) return report_usage(checked.error());
    const auto values =
        is_table(arguments.recording)
            ? checked
            : experiments::with_recorded_settings(*definition, *given, arguments.recording);
    if (!values) return report(values.error());

    auto material =
        is_table(arguments.recording)
            ? from_table(arguments.recording, *layout, definition->analysis.objects.front())
            : from_recording(arguments.recording, *definition, *values);
    if (!material) return report(material.error());
    material->provenance.program_version = config::version();
    const auto released = experiments::recorded_release(arguments.recording);
    const auto free = since(material->trajectories, released);
    auto conditions = conditions_of(
        material->provenance.camera, experiments::recorded_truth(*definition, arguments.recording)
    );
    conditions.released = released;
    if (is_table(arguments.recording)) {
        conditions.metric = material->metric;
        conditions.tilt_u_rad = kHandHeldTilt;
    }
    auto evaluation = experiments::evaluate(
        {*definition, *values, free, conditions, {}},
        material->provenance,
        material->provenance.first_frame
    );
    if (!evaluation) {
        static_cast<void>(report(evaluation.error()));
        return kFailed;
    }
    for (const auto& warning : material->warnings)
        evaluation->result["warnings"].push_back(warning);
    if (!arguments.out.empty()) {
        auto written =
            write_analysis(arguments.out, *definition, *evaluation, material->trajectories);
        if (!written) return report(written.error());
    }
    print_json(evaluation->result);
    return kOk;
}

}  // namespace kinectlab::commands
