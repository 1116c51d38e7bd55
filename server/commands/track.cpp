#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "server/commands/arguments.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/output.hpp"
#include "server/commands/pose_table.hpp"
#include "server/commands/tracked_recording.hpp"
#include "server/config/version.hpp"
#include "server/experiments/model_files.hpp"
#include "server/experiments/objects_json.hpp"
#include "server/experiments/poses_csv.hpp"
#include "server/experiments/preprocess_json.hpp"
#include "server/experiments/result_json.hpp"

namespace kinectlab::commands {
namespace {

using nlohmann::json;

struct Arguments {
    std::string recording;
    std::string objects;
    std::string out;
};

std::optional<int> parse(int argc, char** argv, Arguments& arguments) {
    CLI::App app(
        "Follows objects through a recording. The poses are CSV in the lab frame, on stdout, or in "
        "a file with a summary on stdout.",
        "kinectlab track"
    );
    app.add_option("RECORDING", arguments.recording, "folder in the TUM layout, .pcd or .oni")
        ->required();
    app.add_option("--objects", arguments.objects, "JSON file with the objects to track")
        ->required();
    app.add_option("--out", arguments.out, "CSV file for the poses")->check(check_path);
    return parse_arguments(app, argc, argv);
}

json count_states(const Trajectory& trajectory) {
    std::map<std::string, std::size_t> counts = {{"tracked", 0}, {"interpolated", 0}, {"lost", 0}};
    for (const auto& sample : trajectory.samples)
        ++counts[experiments::to_text(sample.status)];
    json object = {{"name", trajectory.object}};
    object.update(json(counts));
    return object;
}

// How many things had moved in each frame, for methods that report any number of them.
json count_moved(const TrackedRecording& recording) {
    std::map<TimeNs, std::size_t> moved;
    for (std::size_t i = 0; i < recording.objects.size(); ++i) {
        if (!finds_many(recording.objects[i])) continue;
        for (const auto& sample : recording.samples[i])
            moved[sample.t] += sample.status == TrackStatus::tracked ? 1 : 0;
    }
    json list = json::array();
    for (std::size_t i = 0; i < recording.frames.size(); ++i) {
        const auto found = moved.find(recording.frames[i]);
        list.push_back(
            {{"frame", i + 1},
             {"t_ns", recording.frames[i]},
             {"moved", found == moved.end() ? 0 : found->second}}
        );
    }
    return list;
}

json summary_of(
    const TrackedRecording& recording,
    const std::vector<Trajectory>& trajectories,
    const Arguments& arguments
) {
    json objects = json::array();
    for (const auto& trajectory : trajectories)
        objects.push_back(count_states(trajectory));
    json summary = {
        {"recording", arguments.recording},
        {"poses", arguments.out},
        {"frames", recording.frames.size()},
        {"frames_lost", recording.frames_lost},
        {"learned_frames", recording.learned_frames},
        {"lab_frame",
         recording.source.T_lab_cam ? "known" : "assumed: level camera that looks along y"},
        {"objects", std::move(objects)},
        {"provenance",
         {{"program", "kinectlab"},
          {"version", config::version()},
          {"camera", experiments::to_json(recording.source.camera)},
          {"preprocess", experiments::to_json(recording.preprocess)}}}};
    if (std::any_of(recording.objects.begin(), recording.objects.end(), finds_many))
        summary["moved_per_frame"] = count_moved(recording);
    return summary;
}

}  // namespace

int track(int argc, char** argv) {
    Arguments arguments;
    if (const auto status = parse(argc, argv, arguments)) return *status;
    auto plan = experiments::load_tracking_plan(arguments.objects);
    if (!plan) return report_usage(plan.error());
    for (const auto& warning : experiments::warnings_of(plan->objects))
        std::fprintf(stderr, "warning: %s\n", warning.c_str());
    const auto recording = track_recording(arguments.recording, std::move(*plan));
    if (!recording) return report(recording.error());

    const auto trajectories = trajectories_of(*recording);
    const std::string csv = poses_to_csv(trajectories);
    if (arguments.out.empty()) {
        std::fwrite(csv.data(), 1, csv.size(), stdout);
        return kOk;
    }
    if (auto written = write_text_file(arguments.out, csv); !written)
        return report(written.error());
    print_json(summary_of(*recording, trajectories, arguments));
    return kOk;
}

}  // namespace kinectlab::commands
