#include <charconv>
#include <cmath>
#include <numbers>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/sensor/sequence_writer.hpp"
#include "pipeline/simulate/simulate_run.hpp"
#include "server/commands/arguments.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/output.hpp"
#include "server/commands/progress.hpp"
#include "server/config/version.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/share_dir.hpp"

namespace kinectlab::commands {
namespace {

using experiments::Values;

// Simulated recordings all begin on 2026-01-01 00:00 UTC: the same seed gives the same files.
constexpr TimeNs kStart = 1'767'225'600 * kNsPerSecond;
constexpr double kAboutToDisplace = 2.0;  // s

struct Arguments {
    std::string experiment;
    std::string out;
    std::string noise = "kinect";
    std::uint64_t seed = 1;
    std::optional<double> seconds;
    std::vector<std::string> settings;
};

// CLI11 lets a minus through to unsigned numbers and takes the largest for one that is too large.
std::string check_seed(const std::string& word) {
    std::uint64_t seed = 0;
    const char* end = word.data() + word.size();
    const auto read = std::from_chars(word.data(), end, seed);
    if (read.ec == std::errc() && read.ptr == end) return {};
    return "is " + word.substr(0, 40) + "; give a whole number from 0 to 18446744073709551615";
}

std::optional<int> parse(int argc, char** argv, Arguments& arguments) {
    CLI::App app(
        "Records a simulated experiment as a folder in the TUM RGB-D layout: at rest for two "
        "seconds, brought to its start, held, released.",
        "kinectlab simulate"
    );
    app.add_option("EXPERIMENT", arguments.experiment, "what to simulate, e.g. pendulum")
        ->required();
    app.add_option("--out", arguments.out, "new folder for the recording")
        ->required()
        ->check(check_path);
    app.add_option("--seconds", arguments.seconds, "of free motion (default: duration_s)")
        ->check(check_number(0.1, 3600.0));
    app.add_option("--seed", arguments.seed, "of the noise; the same seed gives the same files")
        ->check(check_seed)
        ->capture_default_str();
    app.add_option("--noise", arguments.noise, "none, khoshelham or kinect")->capture_default_str();
    app.add_option("--set", arguments.settings, "a parameter, NAME=VALUE; may be repeated")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return parse_arguments(app, argc, argv);
}

// What the definition displaces to, in the actuator's units.
std::optional<double> displacement_of(
    const experiments::Definition& definition, const Values& values
) {
    std::optional<double> value;
    for (const auto& step : definition.sequence) {
        if (step.kind != experiments::SequenceStep::Kind::displace) continue;
        value = experiments::value_of(step.to, values);
        if (value && step.to.parameter && step.to.parameter->ends_with("_deg"))
            *value *= std::numbers::pi / 180.0;
    }
    return value;
}

Result<simulate::RunSettings> run_settings(
    const experiments::Definition& definition, const Values& values, const Arguments& arguments
) {
    const auto noise = simulate::noise_model_named(arguments.noise);
    if (!noise) return tl::unexpected(noise.error());
    auto apparatus = simulate::settings_for(definition.apparatus, values);
    if (!apparatus) return tl::unexpected(apparatus.error());
    simulate::RunSettings run;
    run.rig.apparatus = std::move(*apparatus);
    run.rig.noise = *noise;
    run.rig.seed = arguments.seed;
    run.rig.start = kStart;
    run.displacement = displacement_of(definition, values);
    run.seconds = arguments.seconds.value_or(
        experiments::value_of(definition.duration, values).value_or(run.seconds)
    );
    return run;
}

// A rig tells its camera only once it exists; the recording needs it before the first frame.
Result<SourceInfo> describe(const simulate::RunSettings& run, const std::string& experiment) {
    const auto rig = simulate::SimulatedRig::create(run.rig);
    if (!rig) return tl::unexpected(rig.error());
    SourceInfo info;
    info.name = "simulated " + experiment;
    info.camera = rig->camera();
    info.T_lab_cam = rig->T_lab_cam();
    info.frame_rate_hz = simulate::kFrameRateHz;
    return info;
}

// One body is the object of the experiment; of several each gets a file, and the first both.
void add_truth(TimeNs t, const simulate::Truth& truth, SequenceWriter& writer) {
    const auto pose_of = [t](const simulate::Body& body) {
        return TumPose{t, body.p_lab, body.q_lab_body};
    };
    writer.add_truth(pose_of(truth.body()));
    if (truth.bodies.size() == 1) return;
    for (const auto& body : truth.bodies)
        writer.add_truth_of(body.name, pose_of(body));
}

Result<simulate::RunSummary> record(
    const simulate::RunSettings& run,
    SequenceWriter& writer,
    const std::string& experiment,
    const Values& values
) {
    const double about = run.rest_s + run.held_s + run.seconds + kAboutToDisplace;
    Progress progress("frames", static_cast<std::size_t>(about * simulate::kFrameRateHz));
    auto summary =
        simulate::simulate_run(run, [&](const RgbdFrame& frame, const simulate::Truth& truth) {
            progress.step();
            add_truth(frame.t, truth, writer);
            return writer.add(frame);
        });
    if (!summary) return summary;
    const nlohmann::json settings = {{"experiment", experiment}, {"parameters", values}};
    writer.add_file("experiment.json", settings.dump(1) + "\n");
    writer.finish();
    return summary;
}

nlohmann::json to_json(
    const simulate::RunSummary& summary,
    const simulate::RunSettings& run,
    const Arguments& arguments,
    const Values& values
) {
    return {
        {"experiment", arguments.experiment},
        {"recording", arguments.out},
        {"parameters", values},
        {"seconds", run.seconds},
        {"seed", arguments.seed},
        {"noise", arguments.noise},
        {"frames", summary.frames},
        {"first_free_frame", summary.first_free},
        {"release_s", summary.release_s},
        {"provenance", {{"program", "kinectlab"}, {"version", config::version()}}}};
}

}  // namespace

int simulate(int argc, char** argv) {
    Arguments arguments;
    if (const auto status = parse(argc, argv, arguments)) return *status;

    const auto definition = experiments::load_definition(
        experiments::share_dir() / "experiments", arguments.experiment
    );
    if (!definition) return report_usage(definition.error());
    const auto given = parse_settings(arguments.settings);
    if (!given) return report_usage(given.error());
    if (arguments.seconds && given->contains("duration_s"))
        return report_usage(
            {ErrorCode::invalid_argument,
             "duration_s",
             "is given together with --seconds",
             "give one of them"}
        );
    auto values = experiments::validate(*definition, *given);
    if (!values) return report_usage(values.error());
    const auto run = run_settings(*definition, *values, arguments);
    if (!run) return report_usage(run.error());
    if (const auto& duration = definition->duration.parameter) (*values)[*duration] = run->seconds;
    const auto info = describe(*run, arguments.experiment);
    if (!info) return report_usage(info.error());
    auto writer = SequenceWriter::create(arguments.out, *info);
    if (!writer) return report(writer.error());
    const auto summary = record(*run, *writer, arguments.experiment, *values);
    if (!summary) return report(summary.error());
    print_json(to_json(*summary, *run, arguments, *values));
    return kOk;
}

}  // namespace kinectlab::commands
