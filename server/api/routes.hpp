#pragma once

#include <vector>

#include "server/api/context.hpp"
#include "server/net/router.hpp"

namespace kinectlab::api {

/// The whole interface: each route with its rules applied before its handler. The context must
/// outlive the routes.
[[nodiscard]] std::vector<net::Route> routes(const Context& context);

/// "GET /api/v1/health" and so on, as in the description.
[[nodiscard]] std::vector<std::string> route_names();

}  // namespace kinectlab::api
