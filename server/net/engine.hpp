#pragma once

#include <memory>
#include <string>

#include "server/net/connections.hpp"
#include "server/net/router.hpp"
#include "server/net/server.hpp"

namespace boost::asio {
class io_context;
class thread_pool;
}  // namespace boost::asio

namespace kinectlab::net {

/// What every connection needs; outlives them all. Everything but the workers belongs to the I/O
/// thread.
struct Engine {
    boost::asio::io_context& io;
    boost::asio::thread_pool& workers;
    const Router& router;
    const Limits& limits;
    Connections& connections;
    bool stopping = false;
};

/// Serves an accepted TCP socket until it ends; takes the descriptor over.
void serve_http(
    Engine& engine,
    int socket,
    std::string remote_address,
    std::unique_ptr<Connections::Place> place
);

/// Answers the upgrade request, then serves the WebSocket; takes the descriptor over.
void serve_websocket(
    Engine& engine,
    int socket,
    const Request& request,
    std::unique_ptr<WebSocketEndpoint> endpoint,
    std::unique_ptr<Connections::Place> place
);

}  // namespace kinectlab::net
