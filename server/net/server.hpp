#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "server/net/router.hpp"

namespace kinectlab::net {

/// What one client may cost.
struct Limits {
    std::size_t header_bytes = 16 * 1024;
    std::size_t body_bytes = 64 * 1024;
    std::size_t websocket_message_bytes = 4 * 1024;    ///< from the client
    std::size_t connections = 2048;                    ///< at once
    std::size_t connections_per_address = 256;         ///< a whole class may share one address
    std::chrono::milliseconds idle{60'000};            ///< between two requests
    std::chrono::milliseconds request{15'000};         ///< from a request's first byte to its last
    std::chrono::milliseconds response{30'000};        ///< for a client to take the answer
    std::chrono::milliseconds websocket_idle{30'000};  ///< without any sign of life, pongs included
};

struct ServerSettings {
    std::string address = "127.0.0.1";
    std::uint16_t port = 8080;  ///< 0: any free one
    int workers = 4;            ///< threads for handlers, which may block
    Limits limits;
};

/// HTTP/1.1 and WebSocket on one port. One thread owns all sockets, handlers run on a few workers.
/// The destructor stops at once; stop() lets what is under way finish.
class Server {
public:
    /// Listens and serves from here on. Error `conflict` if the port is taken.
    [[nodiscard]] static Result<std::unique_ptr<Server>> start(
        const ServerSettings& settings, std::vector<Route> routes, Handler fallback
    );

    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server();

    [[nodiscard]] std::uint16_t port() const;

    /// Accepts nobody any more, closes what is idle, lets requests finish and tells WebSockets that
    /// the server goes away; waits for all that, at most `patience`.
    void stop(std::chrono::milliseconds patience);

private:
    struct State;
    explicit Server(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::net
