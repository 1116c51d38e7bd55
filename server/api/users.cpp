#include <nlohmann/json.hpp>

#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"

namespace kinectlab::api {

net::Response get_users(const Call& call) {
    nlohmann::json users = nlohmann::json::array();
    for (const auto& user : call.context.store.users.all())
        users.push_back(to_json(user));
    return json_response(200, {{"users", users}});
}

net::Response post_user(const Call& call) {
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    ObjectReader reader(*body, "", {"username", "display_name", "role"});
    const std::string username = reader.text("username");
    const std::string display_name = reader.text("display_name");
    const std::string role_text = reader.text("role");
    const auto role = lab::role_from_text(role_text);
    if (reader.ok() && !role) {
        reader.refuse(
            "role",
            "is '" + role_text.substr(0, 40) + "'",
            "give student, assistant, instructor, staff or admin"
        );
    }
    if (!reader.ok()) return to_response(reader.error().value());
    const auto account =
        auth::add_account(call.context.store.users, username, display_name, *role, call.now);
    if (!account) return to_response(account.error());
    return json_response(201, to_json(*account));
}

}  // namespace kinectlab::api
