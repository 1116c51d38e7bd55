#include "server/net/request_id.hpp"

#include <atomic>
#include <cstdint>
#include <random>

#include <fmt/core.h>

namespace kinectlab::net {

std::string new_request_id() {
    static const std::uint32_t start = std::random_device{}();
    static std::atomic<std::uint32_t> count{0};
    return fmt::format("{:08x}-{}", start, ++count);
}

}  // namespace kinectlab::net
