#include <nlohmann/json.hpp>

#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/run_access.hpp"
#include "server/api/wire.hpp"
#include "server/lab/permissions.hpp"
#include "server/lab/utc.hpp"
#include "server/rig/run_analysis.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

constexpr std::size_t kMostVersions = 100;

json to_json(const store::StoredResult& result, const Call& call) {
    const auto person =
        result.person ? call.context.store.users.find(*result.person) : std::nullopt;
    return {
        {"version", result.version},
        {"created", lab::to_rfc3339(result.created)},
        {"person", person ? json(person->display_name) : json(nullptr)},
        {"result", json::parse(result.result_json)}};
}

/// {"name": number | null}
Result<std::map<std::string, std::optional<double>>> read_settings(const json& body) {
    std::map<std::string, std::optional<double>> settings;
    if (!body.contains("settings")) return settings;
    if (!body["settings"].is_object())
        return fail(
            ErrorCode::invalid_argument, "settings", "is no object", "give {\"name\": number}"
        );
    for (const auto& [name, value] : body["settings"].items()) {
        if (!value.is_number() && !value.is_null())
            return fail(
                ErrorCode::invalid_argument,
                "settings." + name,
                "is " + value.dump().substr(0, 40),
                "give a number, or null to take it away"
            );
        settings[name] = value.is_null() ? std::nullopt : std::optional(value.get<double>());
    }
    return settings;
}

Error under_settings(Error error) {
    const bool setting = error.code == ErrorCode::invalid_argument && !error.field.empty();
    if (setting && error.field != "objects") error.field = "settings." + error.field;
    return error;
}

}  // namespace

net::Response get_results(const Call& call) {
    auto found = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    json list = json::array();
    for (const auto& result : call.context.store.results.versions(std::get<lab::Run>(found).id))
        list.push_back(to_json(result, call));
    return json_response(200, {{"results", std::move(list)}});
}

net::Response post_result(const Call& call) {
    auto found = visible_run(call);
    if (auto* refusal = std::get_if<net::Response>(&found)) return std::move(*refusal);
    const auto& run = std::get<lab::Run>(found);
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    const ObjectReader reader(*body, "", {"settings"});
    if (!reader.ok()) return to_response(reader.error().value());
    auto settings = read_settings(*body);
    if (!settings) return to_response(settings.error());
    if (!lab::is_final(run.state))
        return problem(409, "this run is not over", "wait until it is, then analyse it again");
    const auto versions = call.context.store.results.versions(run.id);
    if (versions.size() >= kMostVersions)
        return problem(
            409, "this run has 100 results already", "look through those that there are"
        );

    auto definition =
        experiments::read_definition(json::parse(run.definition_json, nullptr, false));
    if (!definition) {
        // A run from before definitions told their analysis.
        auto today = call.context.library.offered(run.experiment);
        if (!today) return to_response(definition.error());
        definition = std::move(*today);
    }
    const auto analysis = rig::analyse_again(
        run,
        call.context.store.poses.of_run(run.id),
        versions.empty() ? std::string("{}") : versions.front().result_json,
        {std::move(*definition), std::move(*settings), call.user().display_name, call.now}
    );
    if (!analysis) return to_response(under_settings(analysis.error()));
    store::StoredResult stored{
        .run = run.id,
        .created = call.now,
        .result_json = analysis->result_json,
        .fit_json = analysis->fit_json,
        .plots_json = analysis->plots_json,
        .warnings = analysis->warnings,
        .person = call.user().id,
    };
    stored.version = call.context.store.results.add(stored);
    return json_response(201, to_json(stored, call));
}

}  // namespace kinectlab::api
