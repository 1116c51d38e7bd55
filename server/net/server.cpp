#include "server/net/server.hpp"

#include <future>
#include <thread>
#include <utility>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <spdlog/spdlog.h>

#include "server/net/engine.hpp"

namespace kinectlab::net {
namespace asio = boost::asio;
using asio::ip::tcp;
using std::chrono::milliseconds;

struct Server::State {
    explicit State(const ServerSettings& settings, std::vector<Route> routes, Handler fallback)
        : limits(settings.limits),
          router(std::move(routes), std::move(fallback)),
          connections(limits.connections, limits.connections_per_address),
          workers(static_cast<std::size_t>(settings.workers)),
          engine{io, workers, router, limits, connections} {}

    ~State() {
        io.stop();
        if (thread.joinable()) thread.join();
        workers.stop();
        workers.join();
    }

    const Limits limits;
    const Router router;
    // Sockets die with the context, and each gives its place back: so the places outlive it.
    Connections connections;
    asio::io_context io{1};
    // Without it the I/O thread would end with the last socket, and stop() would ask nobody.
    asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
    tcp::acceptor acceptor{io};
    asio::steady_timer pause{io};
    asio::thread_pool workers;
    Engine engine;
    std::thread thread;

    void accept();
    void admit(tcp::socket socket);
};

void Server::State::accept() {
    acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
        if (!acceptor.is_open()) return;
        if (!error) {
            admit(std::move(socket));
            accept();
            return;
        }
        // Out of descriptors, most likely: try again when some connections have ended.
        spdlog::warn("cannot accept a connection: {}", error.message());
        pause.expires_after(milliseconds(200));
        pause.async_wait([this](boost::system::error_code) {
            if (acceptor.is_open()) accept();
        });
    });
}

void Server::State::admit(tcp::socket socket) {
    boost::system::error_code error;
    const auto remote = socket.remote_endpoint(error);
    if (error) return;
    const std::string address = remote.address().to_string();
    auto place = connections.admit(address);
    if (!place) {
        spdlog::warn("too many connections, {} turned away", address);
        constexpr std::string_view kBusy =
            "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 5\r\nConnection: close\r\n"
            "Content-Length: 0\r\n\r\n";
        socket.non_blocking(true, error);
        socket.write_some(asio::buffer(kBusy), error);
        return;
    }
    socket.set_option(tcp::no_delay(true), error);
    serve_http(engine, socket.release(), address, std::move(place));
}

Result<std::unique_ptr<Server>> Server::start(
    const ServerSettings& settings, std::vector<Route> routes, Handler fallback
) {
    auto state = std::make_unique<State>(settings, std::move(routes), std::move(fallback));
    boost::system::error_code error;
    const auto address = asio::ip::make_address(settings.address, error);
    if (error) {
        return fail(
            ErrorCode::invalid_argument,
            "listen",
            "'" + settings.address + "' is no IP address",
            "give for example 127.0.0.1:8080 or 0.0.0.0:8080"
        );
    }
    const tcp::endpoint endpoint(address, settings.port);
    auto& acceptor = state->acceptor;
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
        return fail(
            ErrorCode::conflict,
            "listen",
            "cannot listen on " + settings.address + ":" + std::to_string(settings.port) + ": " +
                error.message(),
            "stop the program that uses it, or choose another port with --listen"
        );
    }
    state->accept();
    state->thread = std::thread([&io = state->io] { io.run(); });
    return std::unique_ptr<Server>(new Server(std::move(state)));
}

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}
Server::~Server() = default;

std::uint16_t Server::port() const {
    return state_->acceptor.local_endpoint().port();
}

void Server::stop(milliseconds patience) {
    asio::post(state_->io, [state = state_.get()] {
        state->engine.stopping = true;
        boost::system::error_code ignored;
        state->acceptor.close(ignored);
        state->pause.cancel();
        state->connections.close_all_soon();
    });
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < deadline) {
        std::promise<std::size_t> count;
        asio::post(state_->io, [&] { count.set_value(state_->connections.count()); });
        if (count.get_future().get() == 0) return;
        std::this_thread::sleep_for(milliseconds(20));
    }
}

}  // namespace kinectlab::net
