#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <gtest/gtest.h>

#include "server/net/server.hpp"

namespace kinectlab::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

/// What the endpoints of a test share with the thread that wakes them.
struct Stage {
    std::mutex mutex;
    std::vector<std::function<void()>> wakes;
    std::atomic<int> ended{0};
    std::atomic<int> ended_elsewhere{0};  ///< not on the socket's own thread
    std::atomic<bool> over{false};
};

class StageEndpoint final : public WebSocketEndpoint {
public:
    explicit StageEndpoint(Stage& stage) : stage_(stage) {}

    ~StageEndpoint() override {
        if (std::this_thread::get_id() != home_) ++stage_.ended_elsewhere;
        ++stage_.ended;
    }

    void opened(std::function<void()> wake) override {
        home_ = std::this_thread::get_id();
        const std::lock_guard lock(stage_.mutex);
        stage_.wakes.push_back(std::move(wake));
    }

    std::optional<Message> next() override { return std::nullopt; }
    [[nodiscard]] bool over() const override { return stage_.over; }
    [[nodiscard]] bool received(std::string_view) override { return true; }

private:
    Stage& stage_;
    std::thread::id home_;
};

std::unique_ptr<Server> serve(Stage& stage) {
    const WebSocketHandler open = [&stage](const Request&) -> Upgraded {
        return std::make_unique<StageEndpoint>(stage);
    };
    auto server = Server::start({"127.0.0.1", 0}, {{Method::get, "/live", open}}, {});
    if (!server) throw std::runtime_error(server.error().message);
    return std::move(*server);
}

using Client = beast::websocket::stream<asio::ip::tcp::socket>;

Client connect(asio::io_context& io, const Server& server) {
    Client client(io);
    client.next_layer().connect({asio::ip::make_address("127.0.0.1"), server.port()});
    client.handshake("127.0.0.1", "/live");
    return client;
}

template <class Condition>
bool within(std::chrono::seconds patience, Condition condition) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

// Whoever wakes a viewer holds locks that the viewer's end takes: ending it there would hang.
TEST(WebSocketConnection, EndsOnItsOwnThreadAlsoWhileItIsWoken) {
    constexpr int kClients = 300;
    Stage stage;
    const auto server = serve(stage);
    std::atomic<bool> waking{true};
    std::thread waker([&] {
        while (waking) {
            const std::lock_guard lock(stage.mutex);
            for (const auto& wake : stage.wakes)
                wake();
        }
    });
    asio::io_context io;
    for (int i = 0; i < kClients; ++i) {
        auto client = connect(io, *server);
        client.next_layer().close();  // as a browser that is gone
        const std::lock_guard lock(stage.mutex);
        if (stage.wakes.size() > 4) stage.wakes.erase(stage.wakes.begin());
    }
    EXPECT_TRUE(within(std::chrono::seconds(10), [&] { return stage.ended == kClients; }));
    waking = false;
    waker.join();
    EXPECT_EQ(stage.ended_elsewhere, 0);
}

TEST(WebSocketConnection, IsEndedAlsoWhenNothingIsSentOnIt) {
    Stage stage;
    const auto server = serve(stage);
    asio::io_context io;
    auto client = connect(io, *server);
    stage.over = true;
    beast::flat_buffer buffer;
    boost::system::error_code error;
    client.async_read(buffer, [&error](boost::system::error_code e, std::size_t) { error = e; });
    io.run_for(std::chrono::seconds(5));
    EXPECT_EQ(error, beast::websocket::error::closed);
    EXPECT_EQ(client.reason().code, beast::websocket::close_code::policy_error);
}

}  // namespace
}  // namespace kinectlab::net
