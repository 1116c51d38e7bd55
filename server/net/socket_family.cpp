#include "server/net/socket_family.hpp"

#include <sys/socket.h>

namespace kinectlab::net {

bool is_ipv6(int socket) {
    sockaddr_storage name{};
    socklen_t length = sizeof(name);
    getsockname(socket, reinterpret_cast<sockaddr*>(&name), &length);
    return name.ss_family == AF_INET6;
}

}  // namespace kinectlab::net
