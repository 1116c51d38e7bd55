#pragma once

#include <string>

namespace kinectlab::net {

/// Unique within this run of the server and unlikely to meet one of another; no secret.
[[nodiscard]] std::string new_request_id();

}  // namespace kinectlab::net
