#include "tests/bench/server_client.hpp"

#include <chrono>
#include <stdexcept>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

namespace kinectlab::bench {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using nlohmann::json;

std::int64_t now_ns() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

tcp::endpoint endpoint_of(std::uint16_t port) {
    return {asio::ip::address_v4::loopback(), port};
}

}  // namespace

json ServerClient::request(const std::string& method, const std::string& path, const json& body) {
    asio::io_context io;
    beast::tcp_stream stream(io);
    stream.connect(endpoint_of(port_));
    http::request<http::string_body> request(http::string_to_verb(method), "/api/v1" + path, 11);
    request.set(http::field::host, "localhost");
    request.set(http::field::connection, "close");
    request.set(http::field::cookie, cookie_);
    request.set("X-CSRF-Token", csrf_);
    if (!body.is_null()) {
        request.set(http::field::content_type, "application/json");
        request.body() = body.dump();
    }
    request.prepare_payload();
    http::write(stream, request);

    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(std::uint64_t{64} << 20U);
    http::read(stream, buffer, parser);
    const auto& response = parser.get();
    if (response.result_int() >= 400) {
        throw std::runtime_error(method + " " + path + ": " + response.body());
    }
    const std::string set_cookie(response[http::field::set_cookie]);
    if (!set_cookie.empty()) cookie_ = set_cookie.substr(0, set_cookie.find(';'));
    json answer = json::parse(response.body());
    if (answer.contains("csrf_token")) csrf_ = answer["csrf_token"].get<std::string>();
    return answer;
}

json ServerClient::get(const std::string& path) {
    return request("GET", path, nullptr);
}

void ServerClient::watch(const std::string& rig, const Handle& handle) {
    const std::string base = "/rigs/" + rig + "/live";
    const std::string ticket = request("POST", base + "-ticket", nullptr)["ticket"];
    asio::io_context io;
    beast::websocket::stream<beast::tcp_stream> stream(io);
    stream.next_layer().connect(endpoint_of(port_));
    stream.next_layer().socket().set_option(tcp::no_delay(true));
    stream.handshake("localhost:" + std::to_string(port_), "/api/v1" + base + "?ticket=" + ticket);
    beast::flat_buffer buffer;
    bool more = true;
    while (more) {
        buffer.clear();
        stream.read(buffer);
        const std::int64_t t = now_ns();
        if (!stream.got_text()) continue;
        const json message = json::parse(beast::buffers_to_string(buffer.data()));
        stream.text(true);
        stream.write(asio::buffer(json{{"ack", message["seq"]}}.dump()));
        more = handle(message, t);
    }
    stream.next_layer().close();
}

}  // namespace kinectlab::bench
