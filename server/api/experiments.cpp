#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "pipeline/analysis/analysis.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"

namespace kinectlab::api {

using nlohmann::json;

net::Response get_experiments(const Call& call) {
    json all = json::array();
    for (const auto& entry : call.context.library.list(call.user()))
        all.push_back(entry_json(entry, call.user()));
    return json_response(200, {{"experiments", all}});
}

net::Response get_experiment(const Call& call) {
    const std::string& id = call.parameter("experiment");
    for (const auto& entry : call.context.library.list(call.user())) {
        if (entry.definition.id == id) return json_response(200, entry_json(entry, call.user()));
    }
    return problem(
        404,
        "there is no experiment '" + id.substr(0, 40) + "'",
        "GET /api/v1/experiments lists them"
    );
}

net::Response get_definition_schema(const Call& call) {
    std::ifstream file(call.context.definition_schema, std::ios::binary);
    return {
        200,
        "application/schema+json",
        std::string(std::istreambuf_iterator<char>(file), {}),
        {{"Cache-Control", "no-cache"}}};
}

net::Response get_analyses(const Call&) {
    json all = json::array();
    for (const auto& method : analysis_methods()) {
        json settings = json::array();
        for (const auto& setting : method.settings)
            settings.push_back(
                {{"name", setting.name},
                 {"min", setting.min},
                 {"max", setting.max},
                 {"otherwise", setting.otherwise ? json(*setting.otherwise) : json()},
                 {"required", setting.required},
                 {"help", setting.help}}
            );
        all.push_back(
            {{"name", method.name},
             {"objects", method.objects},
             {"needs_orientation", method.needs_orientation},
             {"settings", std::move(settings)},
             {"results", method.results},
             {"plots", method.plots},
             {"facts", method.facts}}
        );
    }
    return json_response(200, {{"analyses", std::move(all)}});
}

}  // namespace kinectlab::api
