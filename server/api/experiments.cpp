#include <nlohmann/json.hpp>

#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"

namespace kinectlab::api {

net::Response get_experiments(const Call& call) {
    nlohmann::json all = nlohmann::json::array();
    for (const auto& definition : call.context.definitions)
        all.push_back(experiments::to_json(definition));
    return json_response(200, {{"experiments", all}});
}

net::Response get_experiment(const Call& call) {
    const std::string& id = call.parameter("experiment");
    for (const auto& definition : call.context.definitions) {
        if (definition.id == id) return json_response(200, experiments::to_json(definition));
    }
    return problem(
        404,
        "there is no experiment '" + id.substr(0, 40) + "'",
        "GET /api/v1/experiments lists them"
    );
}

}  // namespace kinectlab::api
