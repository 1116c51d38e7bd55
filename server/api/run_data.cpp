#include <nlohmann/json.hpp>

#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/run_access.hpp"
#include "server/api/wire.hpp"
#include "server/experiments/poses_csv.hpp"

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

}  // namespace

net::Response get_poses(const Call& call) {
    auto found = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    const auto& run = std::get<lab::Run>(found);
    const auto trajectories = call.context.store.poses.of_run(run.id);
    // One object for now; with several the first is the experiment's main one.
    const Trajectory none{"", {}};
    const Trajectory& main = trajectories.empty() ? none : trajectories.front();
    return json_response(200, columns_json(main, zero_of(run)));
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
    auto found = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    const auto& run = std::get<lab::Run>(found);
    const auto result = call.context.store.results.latest(run.id);
    if (!result) return no_result(run);
    return json_response(200, json::parse(result->fit_json));
}

}  // namespace kinectlab::api
