#include "server/api/routes.hpp"

#include <array>

#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/auth/tokens.hpp"

namespace kinectlab::api {
namespace {

using lab::Role;
using net::Method;

/// Who may come in at all. What somebody may do to another person's things is the laboratory's
/// business (server/lab/permissions.hpp).
enum class Access {
    anybody,   ///< without a session
    new_here,  ///< with a session, also before the one-time password was replaced
    student,
    admin,
    ticket,  ///< with a one-time ticket in the address: the handler redeems it
};

using Plain = net::Response (*)(const Call&);
using Live = net::Upgraded (*)(const Call&);

struct Entry {
    Method method;
    const char* pattern;
    Access access;
    std::variant<Plain, Live> handler;
};

const std::array kRoutes{
    Entry{Method::get, "/api/v1/health", Access::anybody, get_health},
    Entry{Method::get, "/api/v1/openapi.json", Access::anybody, get_description},

    Entry{Method::post, "/api/v1/session", Access::anybody, post_session},
    Entry{Method::get, "/api/v1/session", Access::new_here, get_session},
    Entry{Method::del, "/api/v1/session", Access::new_here, delete_session},
    Entry{Method::put, "/api/v1/session/password", Access::new_here, put_password},

    Entry{Method::get, "/api/v1/users", Access::admin, get_users},
    Entry{Method::post, "/api/v1/users", Access::admin, post_user},

    Entry{Method::get, "/api/v1/rigs", Access::student, get_rigs},
    Entry{Method::get, "/api/v1/rigs/{rig}", Access::student, get_rig},
    Entry{Method::get, "/api/v1/rigs/{rig}/camera.jpg", Access::student, get_camera_picture},
    Entry{Method::get, "/api/v1/rigs/{rig}/bookings", Access::student, get_rig_bookings},
    Entry{Method::post, "/api/v1/rigs/{rig}/live-ticket", Access::student, post_live_ticket},
    Entry{Method::get, "/api/v1/rigs/{rig}/live", Access::ticket, open_live},

    Entry{Method::get, "/api/v1/experiments", Access::student, get_experiments},
    Entry{Method::post, "/api/v1/experiments", Access::student, post_experiment},
    Entry{Method::get, "/api/v1/experiments/schema.json", Access::student, get_definition_schema},
    Entry{Method::post, "/api/v1/experiments/check", Access::student, check_experiment},
    Entry{Method::post, "/api/v1/experiments/try", Access::student, try_experiment},
    Entry{Method::get, "/api/v1/experiments/{experiment}", Access::student, get_experiment},
    Entry{Method::put, "/api/v1/experiments/{experiment}", Access::student, put_experiment},
    Entry{Method::del, "/api/v1/experiments/{experiment}", Access::student, delete_experiment},
    Entry{
        Method::post,
        "/api/v1/experiments/{experiment}/publish",
        Access::student,
        publish_experiment},
    Entry{Method::get, "/api/v1/analyses", Access::student, get_analyses},

    Entry{Method::get, "/api/v1/bookings", Access::student, get_bookings},
    Entry{Method::post, "/api/v1/bookings", Access::student, post_booking},
    Entry{Method::del, "/api/v1/bookings/{booking}", Access::student, delete_booking},

    Entry{Method::get, "/api/v1/runs", Access::student, get_runs},
    Entry{Method::post, "/api/v1/runs", Access::student, post_run},
    Entry{Method::get, "/api/v1/runs/{run}", Access::student, get_run},
    Entry{Method::post, "/api/v1/runs/{run}/release", Access::student, post_release},
    Entry{Method::post, "/api/v1/runs/{run}/stop", Access::student, post_stop},
    Entry{Method::post, "/api/v1/runs/{run}/abort", Access::student, post_abort},
    Entry{Method::get, "/api/v1/runs/{run}/poses", Access::student, get_poses},
    Entry{Method::get, "/api/v1/runs/{run}/poses.csv", Access::student, get_poses_csv},
    Entry{Method::get, "/api/v1/runs/{run}/fit", Access::student, get_fit},
    Entry{Method::get, "/api/v1/runs/{run}/plots", Access::student, get_plots},
    Entry{Method::get, "/api/v1/runs/{run}/plots/{picture}", Access::student, get_plot_picture},
    Entry{Method::get, "/api/v1/runs/{run}/report", Access::student, get_report},
    Entry{Method::get, "/api/v1/runs/{run}/results", Access::student, get_results},
    Entry{Method::post, "/api/v1/runs/{run}/results", Access::student, post_result},
};

bool changes_something(const net::Request& request) {
    return request.method != Method::get && request.method != Method::head;
}

/// What stands between this person and this route; nothing if all is well.
std::optional<net::Response> refuse(
    const Entry& entry, const net::Request& request, const std::optional<auth::Identity>& who
) {
    if (!who) return problem(401, "you are not signed in", "sign in first");
    const bool csrf_ok =
        auth::same_secret(request.header("X-CSRF-Token").value_or(""), who->csrf_token);
    if (changes_something(request) && !csrf_ok) {
        const Error error{
            {},
            "X-CSRF-Token",
            "is missing or not this session's",
            "send the session's csrf_token in the header X-CSRF-Token"};
        return to_response(403, error);
    }
    if (who->user.must_change_password && entry.access != Access::new_here) {
        return problem(403, "a one-time password only lets you choose your own", "choose it first");
    }
    if (entry.access == Access::admin && !lab::at_least(who->user.role, Role::admin)) {
        return problem(403, "only an administrator may do this");
    }
    return std::nullopt;
}

template <class Reply, class Function>
Reply guarded(
    const Context& context, const Entry& entry, Function function, const net::Request& request
) {
    const TimeNs now = context.now();
    std::optional<auth::Identity> who;
    if (entry.access != Access::anybody && entry.access != Access::ticket) {
        const auto cookie = request.cookie("kinectlab_session");
        if (cookie) who = context.sign_in.identify(std::string(*cookie), now);
        if (auto refusal = refuse(entry, request, who)) return std::move(*refusal);
    }
    const auth::Identity identity = who.value_or(auth::Identity{});
    return function(Call{context, request, identity, now});
}

net::Route to_route(const Context& context, const Entry& entry) {
    if (const auto* plain = std::get_if<Plain>(&entry.handler)) {
        net::Handler handler = [&context, &entry, function = *plain](const net::Request& request) {
            return guarded<net::Response>(context, entry, function, request);
        };
        return {entry.method, entry.pattern, std::move(handler)};
    }
    const auto live = std::get<Live>(entry.handler);
    net::WebSocketHandler handler = [&context, &entry, live](const net::Request& request) {
        return guarded<net::Upgraded>(context, entry, live, request);
    };
    return {entry.method, entry.pattern, std::move(handler)};
}

}  // namespace

std::vector<net::Route> routes(const Context& context) {
    std::vector<net::Route> all;
    for (const Entry& entry : kRoutes)
        all.push_back(to_route(context, entry));
    return all;
}

std::vector<std::string> route_names() {
    std::vector<std::string> names;
    for (const Entry& entry : kRoutes)
        names.push_back(std::string(net::to_text(entry.method)) + " " + entry.pattern);
    return names;
}

}  // namespace kinectlab::api
