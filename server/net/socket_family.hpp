#pragma once

namespace kinectlab::net {

/// Of an open socket's own address; Asio wants to be told when it takes a descriptor over.
[[nodiscard]] bool is_ipv6(int socket);

}  // namespace kinectlab::net
