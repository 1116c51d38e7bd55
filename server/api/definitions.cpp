#include <nlohmann/json.hpp>

#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"
#include "server/lab/permissions.hpp"
#include "server/rig/run_analysis.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

Error under_definition(Error error) {
    if (error.field.rfind("definition", 0) != 0)
        error.field = error.field.empty() ? "definition" : "definition." + error.field;
    return error;
}

/// A person may not make the server read just any file.
bool inside_share(const std::string& model) {
    return model.rfind("models/", 0) == 0 && model.find("..") == std::string::npos;
}

Result<experiments::Definition> read_wish(const json& body) {
    if (!body.contains("definition"))
        return fail(
            ErrorCode::invalid_argument,
            "definition",
            "is missing",
            "give the experiment's definition"
        );
    const json& document = body["definition"];
    const json objects = document.is_object() ? document.value("objects", json()) : json();
    for (const auto& object : objects.is_array() ? objects : json::array()) {
        const json model = object.is_object() ? object.value("model", json()) : json();
        if (!model.is_string() || inside_share(model.get<std::string>())) continue;
        return fail(
            ErrorCode::invalid_argument,
            "definition.objects",
            "name the file " + model.dump().substr(0, 60),
            "name a model that comes with the program, such as models/robot.ply"
        );
    }
    return experiments::read_with_schema(document).map_error(under_definition);
}

bool may_make(const Call& call) {
    return lab::at_least(call.user().role, lab::Role::instructor);
}

net::Response not_yours() {
    return problem(403, "only instructors make experiments");
}

net::Response save(const Call& call, const std::string& id, int status) {
    if (!may_make(call)) return not_yours();
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    const ObjectReader reader(*body, "", {"definition"});
    if (!reader.ok()) return to_response(reader.error().value());
    const auto definition = read_wish(*body);
    if (!definition) return to_response(definition.error());
    if (!id.empty() && definition->id != id)
        return to_response(
            {ErrorCode::invalid_argument,
             "definition.id",
             "is \"" + definition->id.substr(0, 40) + "\"",
             "give the id of the address, " + id}
        );
    const auto saved = call.context.library.save(call.user(), *definition, call.now);
    if (!saved) return to_response(saved.error());
    return json_response(status, entry_json(*saved, call.user()));
}

}  // namespace

net::Response post_experiment(const Call& call) {
    return save(call, "", 201);
}

net::Response put_experiment(const Call& call) {
    return save(call, call.parameter("experiment"), 200);
}

net::Response publish_experiment(const Call& call) {
    const auto done =
        call.context.library.publish(call.user(), call.parameter("experiment"), call.now);
    return done ? no_content() : to_response(done.error());
}

net::Response delete_experiment(const Call& call) {
    const auto done =
        call.context.library.retire(call.user(), call.parameter("experiment"), call.now);
    return done ? no_content() : to_response(done.error());
}

net::Response check_experiment(const Call& call) {
    if (!may_make(call)) return not_yours();
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    const auto definition = read_wish(*body);
    if (definition) return json_response(200, {{"ok", true}});
    const Error& error = definition.error();
    return json_response(
        200,
        {{"ok", false},
         {"error", {{"field", error.field}, {"message", error.message}, {"cure", error.cure}}}}
    );
}

net::Response try_experiment(const Call& call) {
    if (!may_make(call)) return not_yours();
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    ObjectReader reader(*body, "", {"definition", "run"});
    const double number = reader.number("run");
    if (!reader.ok()) return to_response(reader.error().value());
    auto definition = read_wish(*body);
    if (!definition) return to_response(definition.error());
    const auto run = call.context.store.runs.find(static_cast<lab::RunId>(number));
    if (!run || !lab::may_see_run(call.user(), *run))
        return to_response(
            {ErrorCode::not_found, "run", "is none that you may see", "give the number of a run"}
        );
    const auto earlier = call.context.store.results.latest(run->id);
    const auto analysis = rig::analyse_again(
        *run,
        call.context.store.poses.of_run(run->id),
        earlier ? earlier->result_json : std::string("{}"),
        {std::move(*definition), {}, call.user().display_name, call.now}
    );
    if (!analysis) return to_response(analysis.error());
    return json_response(
        200,
        {{"result", json::parse(analysis->result_json)},
         {"plots", json::parse(analysis->plots_json)}}
    );
}

}  // namespace kinectlab::api
