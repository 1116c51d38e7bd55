#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace kinectlab::net {

/// A message ready to go: bytes that many sockets share, and a few of this one's own after them.
struct Message {
    std::shared_ptr<const std::string> shared;
    std::string tail;
    bool binary = false;
};

/// What stands behind one open WebSocket. The transport pulls: it asks for the next message
/// whenever the socket can take one, so whoever answers decides what a slow reader misses.
/// All calls come from the socket's own thread and must not block; the destructor is the end.
class WebSocketEndpoint {
public:
    WebSocketEndpoint() = default;
    WebSocketEndpoint(const WebSocketEndpoint&) = delete;
    WebSocketEndpoint& operator=(const WebSocketEndpoint&) = delete;
    virtual ~WebSocketEndpoint() = default;

    /// Called first. `wake` makes the transport ask again; any thread may call it as long as this
    /// endpoint lives.
    virtual void opened(std::function<void()> wake) = 0;

    [[nodiscard]] virtual std::optional<Message> next() = 0;

    /// Asked before each message: whether the connection is to end here (close code 1008).
    [[nodiscard]] virtual bool over() const = 0;

    /// A text message of the client; false if it makes no sense, which ends the connection.
    [[nodiscard]] virtual bool received(std::string_view text) = 0;
};

}  // namespace kinectlab::net
