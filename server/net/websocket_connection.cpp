#include <array>
#include <atomic>
#include <utility>  // before Asio: its coroutine support uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <spdlog/spdlog.h>

#include "server/net/engine.hpp"
#include "server/net/socket_family.hpp"

namespace kinectlab::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

/// A stream may be over although nothing is sent on it: looked at this often.
constexpr std::chrono::seconds kLookAgain{1};

constexpr int kSendBuffer = 128 * 1024;  ///< bytes: half a second of pictures

/// Without the deflate code: small messages gain nothing and a context costs 300 KB a viewer.
using Stream = websocket::stream<beast::tcp_stream, false>;

class WebSocketConnection;

/// Wakes a connection's writer from any thread. It never owns the connection: whoever wakes may
/// hold locks that the connection's end takes, so only the I/O thread may be the last to let go.
class Waker : public std::enable_shared_from_this<Waker> {
public:
    Waker(asio::io_context& io, std::weak_ptr<WebSocketConnection> sleeper)
        : io_(io), sleeper_(std::move(sleeper)) {}

    void wake();

private:
    asio::io_context& io_;
    std::weak_ptr<WebSocketConnection> sleeper_;
    std::atomic<bool> pending_{false};
};

class WebSocketConnection : public std::enable_shared_from_this<WebSocketConnection> {
public:
    WebSocketConnection(
        Engine& engine,
        tcp::socket socket,
        std::unique_ptr<WebSocketEndpoint> endpoint,
        std::unique_ptr<Connections::Place> place
    )
        : engine_(engine),
          place_(std::move(place)),
          stream_(std::move(socket)),
          sleep_(engine.io),
          endpoint_(std::move(endpoint)) {}

    asio::awaitable<void> run(http::request<http::empty_body> request);
    void look_again() { sleep_.cancel(); }

private:
    asio::awaitable<void> read_all();
    asio::awaitable<void> write_all();
    asio::awaitable<void> close(websocket::close_code code);

    Engine& engine_;
    std::unique_ptr<Connections::Place> place_;
    Stream stream_;
    asio::steady_timer sleep_;  ///< the writer's wait, ended early by whoever has news
    bool leaving_ = false;  ///< the server goes: what waits is still sent, then the socket closes
    bool over_ = false;
    std::unique_ptr<WebSocketEndpoint> endpoint_;
};

/// Many calls before the I/O thread gets round to it count as one.
void Waker::wake() {
    if (pending_.exchange(true)) return;
    asio::post(io_, [self = shared_from_this()] {
        self->pending_ = false;
        if (const auto connection = self->sleeper_.lock()) connection->look_again();
    });
}

asio::awaitable<void> WebSocketConnection::close(websocket::close_code code) {
    if (std::exchange(over_, true)) co_return;
    sleep_.cancel();
    error_code error;
    co_await stream_.async_close(code, asio::redirect_error(asio::use_awaitable, error));
}

asio::awaitable<void> WebSocketConnection::write_all() {
    error_code error;
    while (!over_ && !error) {
        if (endpoint_->over()) co_return co_await close(websocket::close_code::policy_error);
        const auto message = endpoint_->next();
        if (!message && leaving_) co_return co_await close(websocket::close_code::going_away);
        if (!message) {
            sleep_.expires_after(kLookAgain);
            error_code woken;
            co_await sleep_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
            continue;
        }
        stream_.binary(message->binary);
        const std::array<asio::const_buffer, 2> parts{
            asio::buffer(*message->shared), asio::buffer(message->tail)};
        co_await stream_.async_write(parts, asio::redirect_error(asio::use_awaitable, error));
    }
}

asio::awaitable<void> WebSocketConnection::read_all() {
    beast::flat_buffer buffer;
    error_code error;
    while (!over_) {
        co_await stream_.async_read(buffer, asio::redirect_error(asio::use_awaitable, error));
        if (error) break;
        const auto data = buffer.cdata();
        const std::string_view text(static_cast<const char*>(data.data()), data.size());
        if (!stream_.got_text() || !endpoint_->received(text)) {
            spdlog::info("a WebSocket message makes no sense, the connection ends");
            co_await close(websocket::close_code::policy_error);
            break;
        }
        buffer.consume(buffer.size());
        sleep_.cancel();  // an acknowledgement may have opened the window
    }
    over_ = true;
    sleep_.cancel();
}

asio::awaitable<void> WebSocketConnection::run(http::request<http::empty_body> request) {
    websocket::stream_base::timeout timeout;
    timeout.handshake_timeout = std::chrono::seconds(5);
    timeout.idle_timeout = engine_.limits.websocket_idle;
    timeout.keep_alive_pings = true;
    stream_.set_option(timeout);
    stream_.read_message_max(engine_.limits.websocket_message_bytes);
    stream_.auto_fragment(false);
    // What the kernel holds back for a slow viewer is old when it arrives: keep that short.
    stream_.next_layer().socket().set_option(tcp::socket::send_buffer_size(kSendBuffer));

    error_code error;
    co_await stream_.async_accept(request, asio::redirect_error(asio::use_awaitable, error));
    if (error) co_return;

    auto self = shared_from_this();
    place_->close_soon = [weak = weak_from_this()] {
        const auto connection = weak.lock();
        if (!connection) return;
        connection->leaving_ = true;
        connection->sleep_.cancel();
    };
    if (engine_.stopping) place_->close_soon();
    const auto waker = std::make_shared<Waker>(engine_.io, weak_from_this());
    endpoint_->opened([waker] { waker->wake(); });
    auto reader = [self]() -> asio::awaitable<void> {
        co_await self->read_all();
    };
    asio::co_spawn(engine_.io, std::move(reader), asio::detached);
    co_await write_all();
}

}  // namespace

void serve_websocket(
    Engine& engine,
    int socket,
    const Request& request,
    std::unique_ptr<WebSocketEndpoint> endpoint,
    std::unique_ptr<Connections::Place> place
) {
    http::request<http::empty_body> upgrade(http::verb::get, request.path, 11);
    for (const auto& header : request.headers)
        upgrade.insert(header.name, header.value);
    auto connection = std::make_shared<WebSocketConnection>(
        engine,
        tcp::socket(engine.io, is_ipv6(socket) ? tcp::v6() : tcp::v4(), socket),
        std::move(endpoint),
        std::move(place)
    );
    auto life = [connection, upgrade = std::move(upgrade)]() -> asio::awaitable<void> {
        co_await connection->run(upgrade);
    };
    asio::co_spawn(engine.io, std::move(life), asio::detached);
}

}  // namespace kinectlab::net
