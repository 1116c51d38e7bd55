#include <nlohmann/json.hpp>

#include "pipeline/core/nearest_name.hpp"
#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/run_access.hpp"
#include "server/api/wire.hpp"
#include "server/experiments/poses_csv.hpp"
#include "server/lab/utc.hpp"
#include "server/plots/draw.hpp"
#include "server/plots/plot_json.hpp"
#include "server/plots/report.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

std::string to_csv(const std::vector<Trajectory>& trajectories) {
    std::string csv = experiments::poses_csv_header();
    for (const Trajectory& trajectory : trajectories) {
        for (const MotionSample& sample : trajectory.samples)
            experiments::append_pose_row(csv, trajectory.object, sample);
    }
    return csv;
}

TimeNs zero_of(const lab::Run& run) {
    return run.started.value_or(run.created);
}

net::Response no_result(const lab::Run& run) {
    if (!lab::is_final(run.state)) {
        return problem(404, "this run has no result yet", "wait until its analysis is over");
    }
    return problem(
        404,
        "this run has no result: it was " + std::string(lab::to_text(run.state)),
        "its poses are kept; measure again for a result"
    );
}

/// The wanted version of a result, the newest if none is; or why there is none.
std::variant<store::StoredResult, net::Response> wanted_result(
    const Call& call, const lab::Run& run
) {
    if (auto ok = check_query(call.request, {"version"}); !ok) return to_response(ok.error());
    const auto version = query_integer(call.request, "version", 1, 1'000'000);
    if (!version) return to_response(version.error());
    auto& results = call.context.store.results;
    auto result =
        *version ? results.find(run.id, static_cast<int>(**version)) : results.latest(run.id);
    if (result) return std::move(*result);
    if (*version)
        return problem(
            404,
            "this run has no such version of its result",
            "GET its results to see which there are"
        );
    return no_result(run);
}

/// The run that the path names with its wanted result, or the refusal.
struct RunResult {
    lab::Run run;
    store::StoredResult result;
};

std::variant<RunResult, net::Response> visible_result(const Call& call) {
    auto found = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    auto& run = std::get<lab::Run>(found);
    auto result = wanted_result(call, run);
    if (auto* refusal = std::get_if<net::Response>(&result)) return std::move(*refusal);
    return RunResult{std::move(run), std::move(std::get<store::StoredResult>(result))};
}

}  // namespace

net::Response get_poses(const Call& call) {
    auto found = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    const auto& run = std::get<lab::Run>(found);
    if (auto ok = check_query(call.request, {"object"}); !ok) return to_response(ok.error());
    const auto trajectories = call.context.store.poses.of_run(run.id);
    const auto wanted = call.request.query.find("object");
    std::vector<std::string> names;
    for (const auto& trajectory : trajectories) {
        names.push_back(trajectory.object);
        if (wanted == call.request.query.end() || wanted->second == trajectory.object)
            return json_response(200, columns_json(trajectory, zero_of(run)));
    }
    if (wanted == call.request.query.end() || names.empty())
        return json_response(200, columns_json({"", {}}, zero_of(run)));
    return to_response(
        {ErrorCode::not_found,
         "object",
         "is '" + wanted->second.substr(0, 40) + "'",
         did_you_mean(wanted->second, names)}
    );
}

net::Response get_poses_csv(const Call& call) {
    auto found = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    const auto& run = std::get<lab::Run>(found);
    const std::string name = "run-" + std::to_string(run.id) + "-poses.csv";
    return {
        200,
        "text/csv; charset=utf-8",
        to_csv(call.context.store.poses.of_run(run.id)),
        {{"Content-Disposition", "attachment; filename=\"" + name + "\""},
         {"Cache-Control", "no-store"}}};
}

net::Response get_fit(const Call& call) {
    auto found = visible_result(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    return json_response(200, json::parse(std::get<RunResult>(found).result.fit_json));
}

net::Response get_plots(const Call& call) {
    auto found = visible_result(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    return json_response(
        200, {{"plots", json::parse(std::get<RunResult>(found).result.plots_json)}}
    );
}

net::Response get_plot_picture(const Call& call) {
    auto found = visible_result(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    const auto& result = std::get<RunResult>(found).result;
    const std::string& file = call.parameter("picture");
    const auto dot = file.rfind('.');
    const auto format =
        dot == std::string::npos ? std::nullopt : plots::format_named(file.substr(dot + 1));
    const std::string name = file.substr(0, dot);
    const json stored = json::parse(result.plots_json);
    std::vector<std::string> names{"budget"};
    std::string picture;
    for (const auto& plot : stored) {
        names.push_back(plot.value("name", ""));
        if (format && names.back() == name) picture = draw(plots::plot_from_json(plot), *format);
    }
    if (format && name == "budget")
        picture = plots::draw_budget(
            plots::measurements_from_json(
                json::parse(result.result_json).value("results", json::array())
            ),
            *format
        );
    if (picture.empty())
        return problem(
            404,
            "there is no plot '" + file.substr(0, 40) + "'",
            "plots are .svg or .png; " + did_you_mean(name, names)
        );
    return {
        200,
        *format == plots::Format::svg ? "image/svg+xml" : "image/png",
        std::move(picture),
        {{"Cache-Control", "no-store"}}};
}

net::Response get_report(const Call& call) {
    auto found = visible_result(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    const auto& [run, result] = std::get<RunResult>(found);
    const json definition = json::parse(run.definition_json, nullptr, false);
    const json numbers = json::parse(result.result_json);
    const json plots = json::parse(result.plots_json);
    const std::string heading = "Run " + std::to_string(run.id) + " on " + run.rig + " by " +
                                run.user_name + ", " + lab::to_rfc3339(zero_of(run)) + ", result " +
                                std::to_string(result.version);
    return {
        200,
        "text/html; charset=utf-8",
        plots::report_html(
            {definition.is_object() ? definition.value("title", run.experiment) : run.experiment,
             heading,
             definition.is_object() ? definition : json::object(),
             numbers,
             plots}
        ),
        {{"Cache-Control", "no-store"},
         {"Content-Security-Policy",
          "default-src 'none'; img-src data:; style-src 'unsafe-inline'; frame-ancestors 'none'"}}};
}

}  // namespace kinectlab::api
