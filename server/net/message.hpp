#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinectlab::net {

enum class Method { get, head, post, put, patch, del, options, other };

[[nodiscard]] std::string_view to_text(Method method);

struct Header {
    std::string name;
    std::string value;
};

/// A request as it came, already within the transport's limits.
struct Request {
    std::string id;  ///< names this request in the log and in the answer's X-Request-Id
    Method method = Method::get;
    std::string path;                               ///< as sent, without the query
    std::vector<std::string> segments;              ///< of the path, percent-decoded
    std::map<std::string, std::string> query;       ///< decoded; of a repeated name the first
    std::string repeated;                           ///< a name that stands in the query twice
    std::map<std::string, std::string> parameters;  ///< what the route's {names} matched
    std::vector<Header> headers;
    std::string body;
    std::string remote_address;  ///< without the port

    /// The first header of that name, whatever its case.
    [[nodiscard]] std::optional<std::string_view> header(std::string_view name) const;
    [[nodiscard]] std::optional<std::string_view> cookie(std::string_view name) const;
};

struct Response {
    int status = 200;
    std::string content_type;  ///< none if empty
    std::string body;
    std::vector<Header> headers;
};

/// Splits and decodes a request target. Nothing if it is no absolute path or is badly encoded.
struct Target {
    std::string path;
    std::vector<std::string> segments;
    std::map<std::string, std::string> query;
    std::string repeated;
};
[[nodiscard]] std::optional<Target> parse_target(std::string_view target);

/// An RFC 9457 problem document of the transport itself. `detail` is plain text without quotes.
[[nodiscard]] Response problem(int status, std::string_view detail);

/// The reason phrase of RFC 9110, e.g. 404 → "Not Found".
[[nodiscard]] std::string_view reason_phrase(int status);

}  // namespace kinectlab::net
