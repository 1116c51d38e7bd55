#pragma once

#include <variant>

#include "server/api/call.hpp"
#include "server/lab/run.hpp"

namespace kinectlab::api {

/// The run that the path names, if this person may see it; else the refusal.
[[nodiscard]] std::variant<lab::Run, net::Response> visible_run(const Call& call);
[[nodiscard]] net::Response no_such_run();

}  // namespace kinectlab::api
