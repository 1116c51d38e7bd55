#include "server/net/origin.hpp"

namespace kinectlab::net {

bool same_origin(const Request& request) {
    const auto origin = request.header("Origin");
    if (!origin) return true;
    const auto host = request.header("Host");
    if (!host || host->empty()) return false;
    const auto scheme_end = origin->find("://");
    if (scheme_end == std::string_view::npos) return false;
    const auto scheme = origin->substr(0, scheme_end);
    return (scheme == "http" || scheme == "https") && origin->substr(scheme_end + 3) == *host;
}

}  // namespace kinectlab::net
