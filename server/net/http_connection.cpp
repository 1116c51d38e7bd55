#include <chrono>
#include <ctime>
#include <utility>  // before Asio: its coroutine support uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <spdlog/spdlog.h>

#include "server/net/engine.hpp"
#include "server/net/origin.hpp"
#include "server/net/request_id.hpp"
#include "server/net/security_headers.hpp"
#include "server/net/socket_family.hpp"

namespace kinectlab::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

Method to_method(http::verb verb) {
    switch (verb) {
        case http::verb::get:
            return Method::get;
        case http::verb::head:
            return Method::head;
        case http::verb::post:
            return Method::post;
        case http::verb::put:
            return Method::put;
        case http::verb::patch:
            return Method::patch;
        case http::verb::delete_:
            return Method::del;
        case http::verb::options:
            return Method::options;
        default:
            return Method::other;
    }
}

std::string http_date() {
    std::array<char, 32> text{};
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    const auto length = std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc);
    return {text.data(), length};
}

/// One client's socket and the requests on it, one after the other.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(
        Engine& engine,
        tcp::socket socket,
        std::string remote,
        std::unique_ptr<Connections::Place> place
    )
        : engine_(engine),
          stream_(std::move(socket)),
          buffer_(engine.limits.header_bytes + engine.limits.body_bytes),
          remote_(std::move(remote)),
          place_(std::move(place)) {}

    asio::awaitable<void> run();

private:
    using Parser = http::request_parser<http::string_body>;

    asio::awaitable<bool> wait_for_first_byte();
    asio::awaitable<error_code> read(Parser& parser);
    asio::awaitable<Response> answer(Request& request, bool is_upgrade);
    asio::awaitable<Response> call(const Handler& handler, const Request& request);
    asio::awaitable<Response> upgrade(const WebSocketHandler& handler, const Request& request);
    asio::awaitable<bool> write(Response response, const Request& request, bool keep_alive);
    asio::awaitable<void> drain();
    [[nodiscard]] std::optional<Request> to_request(Parser::value_type& message) const;

    Engine& engine_;
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_;
    std::string remote_;
    std::unique_ptr<Connections::Place> place_;
    std::unique_ptr<WebSocketEndpoint> endpoint_;  ///< set when a request became a WebSocket
    bool idle_ = false;
};

std::optional<Request> HttpConnection::to_request(Parser::value_type& message) const {
    auto target = parse_target({message.target().data(), message.target().size()});
    const bool host_missing = message.version() == 11 && message.count(http::field::host) != 1;
    if (!target || host_missing) return std::nullopt;
    Request request;
    request.method = to_method(message.method());
    request.path = std::move(target->path);
    request.segments = std::move(target->segments);
    request.query = std::move(target->query);
    request.repeated = std::move(target->repeated);
    for (const auto& field : message) {
        request.headers.push_back({std::string(field.name_string()), std::string(field.value())});
    }
    request.body = std::move(message.body());
    return request;
}

/// A keep-alive connection may wait long; false if nothing came.
asio::awaitable<bool> HttpConnection::wait_for_first_byte() {
    if (buffer_.size() > 0) co_return true;
    idle_ = true;
    stream_.expires_after(engine_.limits.idle);
    error_code error;
    const auto space = buffer_.prepare(4096);
    const std::size_t count =
        co_await stream_.async_read_some(space, asio::redirect_error(asio::use_awaitable, error));
    idle_ = false;
    buffer_.commit(count);
    co_return !error;
}

asio::awaitable<error_code> HttpConnection::read(Parser& parser) {
    parser.header_limit(static_cast<std::uint32_t>(engine_.limits.header_bytes));
    parser.body_limit(engine_.limits.body_bytes);
    stream_.expires_after(engine_.limits.request);
    error_code error;
    co_await http::async_read_header(
        stream_, buffer_, parser, asio::redirect_error(asio::use_awaitable, error)
    );
    if (error) co_return error;
    if (beast::iequals(parser.get()[http::field::expect], "100-continue")) {
        http::response<http::empty_body> go_on(http::status::continue_, 11);
        co_await http::async_write(
            stream_, go_on, asio::redirect_error(asio::use_awaitable, error)
        );
        if (error) co_return error;
    }
    co_await http::async_read(
        stream_, buffer_, parser, asio::redirect_error(asio::use_awaitable, error)
    );
    co_return error;
}

Response to_problem(const error_code& error) {
    if (error == http::error::body_limit) return problem(413, "the body is too large");
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
        return problem(431, "the header is too large");
    }
    return problem(400, "this is not a valid HTTP/1.1 request");
}

/// Handlers may block, so they run on a worker; the connection's thread goes on meanwhile.
template <class Reply, class Work>
asio::awaitable<Reply> on_worker(Engine& engine, Work work) {
    auto job = [work = std::move(work)]() -> asio::awaitable<Reply> {
        co_return work();
    };
    co_return co_await asio::co_spawn(engine.workers, std::move(job), asio::use_awaitable);
}

Response broken(const Request& request, const char* what) {
    spdlog::error("[{}] {} {}: {}", request.id, to_text(request.method), request.path, what);
    return problem(500, "the server failed; its log has more under request " + request.id);
}

asio::awaitable<Response> HttpConnection::call(const Handler& handler, const Request& request) {
    auto work = [&handler, &request] {
        try {
            return handler(request);
        } catch (const std::exception& error) {
            return broken(request, error.what());
        }
    };
    co_return co_await on_worker<Response>(engine_, std::move(work));
}

asio::awaitable<Response> HttpConnection::upgrade(
    const WebSocketHandler& handler, const Request& request
) {
    auto work = [&handler, &request]() -> Upgraded {
        try {
            return handler(request);
        } catch (const std::exception& error) {
            return broken(request, error.what());
        }
    };
    auto upgraded = co_await on_worker<Upgraded>(engine_, std::move(work));
    if (auto* refusal = std::get_if<Response>(&upgraded)) co_return std::move(*refusal);
    endpoint_ = std::move(std::get<std::unique_ptr<WebSocketEndpoint>>(upgraded));
    co_return Response{101};
}

asio::awaitable<Response> HttpConnection::answer(Request& request, bool is_upgrade) {
    const auto found = engine_.router.find(request);
    if (const auto* response = std::get_if<Response>(&found)) co_return *response;
    if (const auto* handler = std::get_if<const Handler*>(&found)) {
        co_return co_await call(**handler, request);
    }
    if (!is_upgrade) {
        Response response = problem(426, "this address speaks WebSocket only");
        response.headers.push_back({"Upgrade", "websocket"});
        co_return response;
    }
    // Bytes after the request would be frames that nobody may send before the answer.
    if (buffer_.size() > 0) co_return problem(400, "data before the WebSocket was open");
    if (!same_origin(request)) co_return problem(403, "a page of another site may not do this");
    co_return co_await upgrade(*std::get<const WebSocketHandler*>(found), request);
}

/// False if the client is gone.
asio::awaitable<bool> HttpConnection::write(
    Response response, const Request& request, bool keep_alive
) {
    http::response<http::string_body> message;
    message.version(11);
    message.result(static_cast<unsigned>(response.status));
    message.reason(std::string(reason_phrase(response.status)));
    for (const auto& header : kSecurityHeaders)
        message.set(header.name, header.value);
    message.set(http::field::date, http_date());
    if (!request.id.empty()) message.set("X-Request-Id", request.id);
    if (!response.content_type.empty()) {
        message.set(http::field::content_type, response.content_type);
    }
    for (const auto& header : response.headers) {
        // A page that stands alone says more strictly what it may load; cookies come several times.
        if (header.name == "Content-Security-Policy")
            message.set(header.name, header.value);
        else
            message.insert(header.name, header.value);
    }
    message.keep_alive(keep_alive);
    if (response.status != 204 && response.status != 304) {
        message.content_length(response.body.size());
    }
    if (request.method != Method::head) message.body() = std::move(response.body);

    stream_.expires_after(engine_.limits.response);
    error_code error;
    http::response_serializer<http::string_body> serializer(message);
    if (request.method == Method::head) {
        co_await http::async_write_header(
            stream_, serializer, asio::redirect_error(asio::use_awaitable, error)
        );
    } else {
        co_await http::async_write(
            stream_, serializer, asio::redirect_error(asio::use_awaitable, error)
        );
    }
    co_return !error;
}

/// A socket closed with unread data resets the connection, and the client may lose the answer.
asio::awaitable<void> HttpConnection::drain() {
    error_code error;
    stream_.socket().shutdown(tcp::socket::shutdown_send, error);
    stream_.expires_after(std::chrono::seconds(2));
    std::array<char, 4096> dump{};
    for (int i = 0; i < 256 && !error; ++i) {
        co_await stream_.async_read_some(
            asio::buffer(dump), asio::redirect_error(asio::use_awaitable, error)
        );
    }
}

asio::awaitable<void> HttpConnection::run() {
    place_->close_soon = [weak = weak_from_this()] {
        const auto self = weak.lock();
        if (self && self->idle_) self->stream_.close();
    };
    while (true) {
        if (engine_.stopping || !co_await wait_for_first_byte()) co_return;
        const auto started = Clock::now();
        Parser parser;
        const error_code error = co_await read(parser);
        if (error == http::error::end_of_stream || error == http::error::partial_message) co_return;
        if (error &&
            error.category() != http::make_error_code(http::error::bad_method).category()) {
            co_return;  // the connection broke or took too long
        }

        std::optional<Request> request;
        if (!error) request = to_request(parser.get());
        const bool readable = request.has_value();
        if (!readable) request.emplace();
        request->id = new_request_id();
        request->remote_address = remote_;

        Response response;
        if (error) {
            response = to_problem(error);
        } else if (!readable) {
            response = problem(400, "the address or the Host header is not valid");
        } else {
            const bool is_upgrade = beast::websocket::is_upgrade(parser.get());
            response = co_await answer(*request, is_upgrade);
        }

        const auto ms = std::chrono::duration<double, std::milli>(Clock::now() - started).count();
        // The query stays out of the log: it may hold a ticket.
        spdlog::info(
            "[{}] {} {} {} {} {:.1f} ms",
            request->id,
            remote_,
            to_text(request->method),
            request->path,
            response.status,
            ms
        );
        if (endpoint_) {
            stream_.expires_never();
            tcp::socket socket = stream_.release_socket();
            serve_websocket(
                engine_, socket.release(), *request, std::move(endpoint_), std::move(place_)
            );
            co_return;
        }
        const bool keep_alive = readable && parser.get().keep_alive() && !engine_.stopping;
        if (!co_await write(std::move(response), *request, keep_alive)) co_return;
        if (!keep_alive) {
            co_await drain();
            co_return;
        }
    }
}

}  // namespace

void serve_http(
    Engine& engine,
    int socket,
    std::string remote_address,
    std::unique_ptr<Connections::Place> place
) {
    const auto protocol = is_ipv6(socket) ? tcp::v6() : tcp::v4();
    auto connection = std::make_shared<HttpConnection>(
        engine,
        tcp::socket(engine.io, protocol, socket),
        std::move(remote_address),
        std::move(place)
    );
    auto life = [connection]() -> asio::awaitable<void> {
        co_await connection->run();
    };
    asio::co_spawn(engine.io, std::move(life), asio::detached);
}

}  // namespace kinectlab::net
