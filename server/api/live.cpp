#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"
#include "server/lab/utc.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

/// {"ack": seq} and nothing else; nothing if the client says something else.
std::optional<std::uint64_t> parse_acknowledgement(std::string_view text) {
    const json message = json::parse(text, nullptr, false);
    if (!message.is_object() || message.size() != 1) return std::nullopt;
    const auto ack = message.find("ack");
    if (ack == message.end() || !ack->is_number_unsigned()) return std::nullopt;
    return ack->get<std::uint64_t>();
}

/// Joins a viewer's queue to its socket.
class LiveSocket final : public net::WebSocketEndpoint {
public:
    LiveSocket(
        std::unique_ptr<live::Hub::Place> place,
        std::shared_ptr<const auth::LiveSessions::Stream> session
    )
        : place_(std::move(place)), session_(std::move(session)) {}

    void opened(std::function<void()> wake) override { place_->viewer().on_wake(std::move(wake)); }

    std::optional<net::Message> next() override {
        auto message = place_->viewer().next();
        if (!message) return std::nullopt;
        return net::Message{std::move(message->shared), std::move(message->tail), message->binary};
    }

    bool over() const override { return session_->over(); }

    bool received(std::string_view text) override {
        const auto seq = parse_acknowledgement(text);
        if (seq) place_->viewer().acknowledge(*seq);
        return seq.has_value();
    }

private:
    std::unique_ptr<live::Hub::Place> place_;
    std::shared_ptr<const auth::LiveSessions::Stream> session_;
};

net::Response no_such_rig() {
    return problem(404, "there is no such rig");
}

}  // namespace

net::Response post_live_ticket(const Call& call) {
    const std::string& rig = call.parameter("rig");
    if (!call.context.rigs.find(rig, call.now)) return no_such_rig();
    const auto ticket =
        call.context.tickets.issue({call.user().id, call.who.token_hash}, rig, call.now);
    return json_response(
        201, {{"ticket", ticket.token}, {"expires_at", lab::to_rfc3339(ticket.expires)}}
    );
}

net::Upgraded open_live(const Call& call) {
    const std::string& rig = call.parameter("rig");
    const auto ticket = call.request.query.find("ticket");
    const bool given = ticket != call.request.query.end();
    const auto holder = given ? call.context.tickets.redeem(ticket->second, rig, call.now)
                              : std::optional<auth::LiveTickets::Holder>();
    if (!holder || !call.context.sign_in.is_open(holder->session, call.now)) {
        return problem(
            401,
            "the ticket is missing, used, too old, for another rig or of a session that is over",
            "ask for a new one"
        );
    }
    if (!call.context.rigs.find(rig, call.now)) return no_such_rig();
    spdlog::info("[{}] user {} watches {}", call.request.id, holder->user, rig);
    return std::make_unique<LiveSocket>(
        call.context.hub.watch(rig), call.context.live_sessions.watch(holder->session)
    );
}

}  // namespace kinectlab::api
