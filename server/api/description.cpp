#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "pipeline/core/version.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"

namespace kinectlab::api {

net::Response get_health(const Call& /*call*/) {
    return json_response(200, {{"status", "ok"}, {"version", kVersion}});
}

net::Response get_description(const Call& call) {
    std::ifstream file(call.context.description, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (text.empty()) throw std::runtime_error("cannot read " + call.context.description.string());
    return {200, "application/json", std::move(text), {{"Cache-Control", "no-cache"}}};
}

}  // namespace kinectlab::api
