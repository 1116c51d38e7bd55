#include <nlohmann/json.hpp>

#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"

namespace kinectlab::api {
namespace {

/// Lax enough for nothing: other sites' pages never send it, scripts never see it.
net::Header session_cookie(const std::string& token, TimeNs life) {
    return {
        "Set-Cookie",
        "kinectlab_session=" + token + "; Path=/api/v1; HttpOnly; SameSite=Strict; Max-Age=" +
            std::to_string(life / kNsPerSecond)};
}

net::Response signed_in(const auth::SignedIn& session) {
    net::Response response = json_response(200, session_json(session.identity));
    response.headers.push_back(session_cookie(session.token, auth::kSessionLife));
    return response;
}

net::Response too_many(TimeNs wait) {
    const std::string seconds = std::to_string(wait / kNsPerSecond + 1);
    net::Response response =
        problem(429, "there were too many wrong passwords", "try again in " + seconds + " s");
    response.headers.push_back({"Retry-After", seconds});
    return response;
}

}  // namespace

net::Response post_session(const Call& call) {
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    ObjectReader reader(*body, "", {"username", "password"});
    const std::string username = reader.text("username");
    const std::string password = reader.text("password");
    if (!reader.ok()) return to_response(reader.error().value());

    const auto outcome =
        call.context.sign_in.sign_in(username, password, call.request.remote_address, call.now);
    if (const auto* session = std::get_if<auth::SignedIn>(&outcome)) return signed_in(*session);
    if (const auto* wait = std::get_if<auth::TooManyAttempts>(&outcome))
        return too_many(wait->wait);
    return problem(401, "user name or password is wrong", "try again");
}

net::Response get_session(const Call& call) {
    return json_response(200, session_json(call.who));
}

net::Response delete_session(const Call& call) {
    call.context.sign_in.sign_out(call.who);
    call.context.live_sessions.look();
    net::Response response = no_content();
    response.headers.push_back(session_cookie("", 0));
    return response;
}

net::Response put_password(const Call& call) {
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    ObjectReader reader(*body, "", {"current", "new"});
    const std::string current = reader.text("current");
    const std::string replacement = reader.text("new");
    if (!reader.ok()) return to_response(reader.error().value());

    const auto session = call.context.sign_in.change_password(
        call.who, current, replacement, call.request.remote_address, call.now
    );
    if (session) {
        call.context.live_sessions.look();
        return signed_in(*session);
    }
    if (session.error().code == ErrorCode::unavailable) return to_response(429, session.error());
    return to_response(session.error());
}

}  // namespace kinectlab::api
