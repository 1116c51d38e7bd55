#pragma once

#include "server/net/message.hpp"

namespace kinectlab::net {

/// Browsers let any page open a WebSocket anywhere and send the cookies along, so the page's origin
/// has to be ours. Programs that are no browsers send no Origin and pass; they need a ticket
/// anyway.
[[nodiscard]] bool same_origin(const Request& request);

}  // namespace kinectlab::net
