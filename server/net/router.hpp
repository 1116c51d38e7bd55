#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/net/message.hpp"
#include "server/net/websocket.hpp"

namespace kinectlab::net {

/// Handlers run on a worker thread and may block; several run at once.
using Handler = std::function<Response(const Request&)>;
using Upgraded = std::variant<Response, std::unique_ptr<WebSocketEndpoint>>;
using WebSocketHandler = std::function<Upgraded(const Request&)>;

/// One line of the route table. A pattern's {name} matches one segment that is not empty.
struct Route {
    Method method = Method::get;
    std::string pattern;  ///< e.g. "/api/v1/rigs/{rig}/bookings"
    std::variant<Handler, WebSocketHandler> handler;
};

class Router {
public:
    /// `fallback` answers GET for whatever no pattern matches: the static files.
    Router(std::vector<Route> routes, Handler fallback);

    using Found = std::variant<const Handler*, const WebSocketHandler*, Response>;

    /// Fills request.parameters. The answer is already there for 404 and for 405, which names the
    /// methods that would do. HEAD is served by the handler of GET.
    [[nodiscard]] Found find(Request& request) const;

private:
    struct Entry {
        Route route;
        std::vector<std::string> segments;
    };
    std::vector<Entry> entries_;
    Handler fallback_;
};

}  // namespace kinectlab::net
