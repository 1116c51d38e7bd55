#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"
#include "server/net/message.hpp"

namespace kinectlab::api {

/// RFC 9457, with `errors: [{field, message, cure}]` where a field is to blame.
[[nodiscard]] net::Response to_response(const Error& error);
[[nodiscard]] net::Response to_response(int status, const Error& error);
[[nodiscard]] net::Response to_response(
    int status, const Error& error, const nlohmann::json& more  ///< members of the document
);

[[nodiscard]] net::Response problem(int status, std::string message, std::string cure = {});

}  // namespace kinectlab::api
