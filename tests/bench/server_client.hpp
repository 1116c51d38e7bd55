#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace kinectlab::bench {

/// One person at the server's interface, blocking.
class ServerClient {
public:
    explicit ServerClient(std::uint16_t port) : port_(port) {}

    /// The answer's JSON; `path` follows /api/v1. Throws on any status from 400 on.
    nlohmann::json request(
        const std::string& method, const std::string& path, const nlohmann::json& body
    );
    nlohmann::json get(const std::string& path);

    /// Hands on every text message with the time it was read (ns since the epoch), acknowledges it,
    /// and goes on until `handle` returns false.
    using Handle = std::function<bool(const nlohmann::json& message, std::int64_t t)>;
    void watch(const std::string& rig, const Handle& handle);

private:
    std::uint16_t port_;
    std::string cookie_;
    std::string csrf_;
};

}  // namespace kinectlab::bench
