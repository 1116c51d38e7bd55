#include <algorithm>
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

/// Why frames of an object are lost, and how many for each reason.
std::map<std::string, std::size_t> reasons_of(const std::vector<TrackSample>& samples) {
    std::map<std::string, std::size_t> reasons;
    for (const auto& sample : samples)
        if (sample.status == TrackStatus::lost && !sample.quality.why_lost.empty())
            ++reasons[std::string(sample.quality.why_lost)];
    return reasons;
}

/// An object that is hardly ever seen is most likely a wrong setting: its commonest reason is told.
void tell_lost(const TrackedRecording& recording) {
    for (std::size_t i = 0; i < recording.objects.size(); ++i) {
        const auto& samples = recording.samples[i];
        const auto lost = static_cast<std::size_t>(std::count_if(
            samples.begin(),
            samples.end(),
            [](const TrackSample& sample) { return sample.status == TrackStatus::lost; }
        ));
        const auto reasons = reasons_of(samples);
        if (2 * lost <= samples.size() || reasons.empty()) continue;
        const auto most =
            std::max_element(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) {
                return a.second < b.second;
            });
        std::fprintf(
            stderr,
            "warning: %s: lost in %zu of %zu frames, in %zu because %s\n",
            recording.objects[i].name.c_str(),
            lost,
            samples.size(),
            most->second,
            most->first.c_str()
        );
    }
}

json summary_of(
    const TrackedRecording& recording,
    const std::vector<Trajectory>& trajectories,
    const Arguments& arguments
) {
    json objects = json::array();
    for (const auto& trajectory : trajectories)
        objects.push_back(count_states(trajectory));
    json why_lost = json::object();
    for (std::size_t i = 0; i < recording.objects.size(); ++i)
        if (auto reasons = reasons_of(recording.samples[i]); !reasons.empty())
            why_lost[recording.objects[i].name] = std::move(reasons);
    json summary = {
        {"recording", arguments.recording},
        {"poses", arguments.out},
        {"frames", recording.frames.size()},
        {"frames_lost", recording.frames_lost},
        {"learned_frames", recording.learned_frames},
        {"lab_frame",
         recording.source.T_lab_cam ? "known" : "assumed: level camera that looks along y"},
        {"objects", std::move(objects)},
        {"why_lost", std::move(why_lost)},
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

    tell_lost(*recording);
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
