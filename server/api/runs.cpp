#include <nlohmann/json.hpp>

#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/run_access.hpp"
#include "server/api/wire.hpp"
#include "server/lab/permissions.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

net::Response run_response(int status, const Result<lab::Run>& run) {
    return run ? json_response(status, to_json(*run)) : to_response(run.error());
}

Result<lab::Parameters> read_parameters(const json& body) {
    lab::Parameters parameters;
    const auto found = body.find("parameters");
    if (found == body.end()) return parameters;
    if (!found->is_object()) {
        return fail(
            ErrorCode::invalid_argument, "parameters", "is no object", "give {\"name\": number}"
        );
    }
    for (const auto& [name, value] : found->items()) {
        if (value.is_number()) {
            parameters[name] = value.get<double>();
            continue;
        }
        return fail(
            ErrorCode::invalid_argument,
            "parameters." + name,
            "is " + value.dump().substr(0, 40),
            "give a number"
        );
    }
    return parameters;
}

using Command = Result<lab::Run> (rig::RigService::*)(const lab::User&, lab::RunId, TimeNs);

net::Response command(const Call& call, Command what) {
    const auto id = parse_id(call.parameter("run"));
    if (!id) return no_such_run();
    return run_response(200, (call.context.rigs.*what)(call.user(), *id, call.now));
}

}  // namespace

net::Response no_such_run() {
    return problem(404, "there is no such run");
}

std::variant<lab::Run, net::Response> visible_run(const Call& call) {
    const auto id = parse_id(call.parameter("run"));
    auto run = id ? call.context.store.runs.find(*id) : std::nullopt;
    if (!run) return no_such_run();
    if (auto ok = lab::may_see_run(call.user(), *run); !ok) return to_response(ok.error());
    return std::move(*run);
}

net::Response get_runs(const Call& call) {
    if (auto ok = check_query(call.request, {"limit", "before", "rig", "mine"}); !ok) {
        return to_response(ok.error());
    }
    const auto limit = query_integer(call.request, "limit", 1, 200);
    if (!limit) return to_response(limit.error());
    const auto before =
        query_integer(call.request, "before", 1, std::numeric_limits<std::int64_t>::max());
    if (!before) return to_response(before.error());
    const auto mine = query_flag(call.request, "mine");
    if (!mine) return to_response(mine.error());

    store::RunFilter filter;
    const bool sees_all = lab::at_least(call.user().role, lab::Role::assistant);
    if (*mine || !sees_all) filter.user = call.user().id;
    const auto rig = call.request.query.find("rig");
    if (rig != call.request.query.end()) filter.rig = rig->second;
    filter.before = *before;
    const int count = static_cast<int>(limit->value_or(50));
    filter.limit = count + 1;  // one more tells whether there is a next page

    auto found = call.context.store.runs.list(filter);
    // The runs of a rig that was taken away stay readable; a name that never was one is a slip.
    if (found.empty() && filter.rig && !call.context.rigs.find(*filter.rig, call.now)) {
        return to_response(
            {ErrorCode::invalid_argument,
             "rig",
             "is '" + filter.rig->substr(0, 40) + "'; there is no such rig",
             "give one from the list of rigs"}
        );
    }
    const bool more = found.size() > static_cast<std::size_t>(count);
    if (more) found.pop_back();
    json runs = json::array();
    for (const auto& run : found)
        runs.push_back(to_json(run));
    return json_response(
        200, {{"runs", runs}, {"next", more ? json(found.back().id) : json(nullptr)}}
    );
}

net::Response post_run(const Call& call) {
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    ObjectReader reader(*body, "", {"rig", "experiment", "parameters"});
    rig::RunRequest wish;
    wish.rig = reader.text("rig");
    wish.experiment = reader.text("experiment");
    if (!reader.ok()) return to_response(reader.error().value());
    auto parameters = read_parameters(*body);
    if (!parameters) return to_response(parameters.error());
    wish.parameters = std::move(*parameters);
    return run_response(201, call.context.rigs.start_run(call.user(), wish, call.now));
}

net::Response get_run(const Call& call) {
    auto run = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&run)) return std::move(*refusal);
    return json_response(200, to_json(std::get<lab::Run>(run)));
}

net::Response post_release(const Call& call) {
    return command(call, &rig::RigService::release);
}
net::Response post_stop(const Call& call) {
    return command(call, &rig::RigService::stop);
}
net::Response post_abort(const Call& call) {
    return command(call, &rig::RigService::abort);
}

}  // namespace kinectlab::api
