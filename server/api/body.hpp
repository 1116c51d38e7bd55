#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"
#include "pipeline/core/time.hpp"
#include "server/experiments/strict_json.hpp"
#include "server/net/message.hpp"

namespace kinectlab::api {

/// The request's body as a JSON object; bounded in size by the transport, in depth here. Errors:
/// no JSON (400) or not declared as application/json.
[[nodiscard]] Result<nlohmann::json> read_body(const net::Request& request);

/// A JSON object's members read one by one, as in experiments::ObjectReader.
using experiments::ObjectReader;

/// An RFC 3339 time with any offset, e.g. "2026-11-22T09:00:00Z".
[[nodiscard]] std::optional<TimeNs> parse_time(const std::string& text);
[[nodiscard]] TimeNs read_time(ObjectReader& reader, const std::string& key);

/// A number among the query's parameters. Errors name it.
[[nodiscard]] Result<std::optional<std::int64_t>> query_integer(
    const net::Request& request, const std::string& name, std::int64_t min, std::int64_t max
);
[[nodiscard]] Result<std::optional<TimeNs>> query_time(
    const net::Request& request, const std::string& name
);
/// "true" or "false"; false if it is not given.
[[nodiscard]] Result<bool> query_flag(const net::Request& request, const std::string& name);

/// Refuses parameters that the route does not know, with the nearest one it does.
[[nodiscard]] Result<void> check_query(
    const net::Request& request, const std::vector<std::string>& names
);

/// The id in a path; nothing if it is no positive whole number.
[[nodiscard]] std::optional<std::int64_t> parse_id(const std::string& text);

}  // namespace kinectlab::api
