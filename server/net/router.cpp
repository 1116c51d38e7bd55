#include "server/net/router.hpp"

#include <stdexcept>

namespace kinectlab::net {
namespace {

bool is_parameter(const std::string& segment) {
    return segment.size() > 2 && segment.front() == '{' && segment.back() == '}';
}

std::optional<std::map<std::string, std::string>> match(
    const std::vector<std::string>& pattern, const std::vector<std::string>& segments
) {
    if (pattern.size() != segments.size()) return std::nullopt;
    std::map<std::string, std::string> parameters;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (is_parameter(pattern[i])) {
            if (segments[i].empty()) return std::nullopt;
            parameters[pattern[i].substr(1, pattern[i].size() - 2)] = segments[i];
        } else if (pattern[i] != segments[i]) {
            return std::nullopt;
        }
    }
    return parameters;
}

std::string allow_list(const std::vector<Method>& methods) {
    std::string text;
    for (const Method method : methods) {
        if (!text.empty()) text += ", ";
        text += to_text(method);
        if (method == Method::get) text += ", HEAD";
    }
    return text;
}

}  // namespace

Router::Router(std::vector<Route> routes, Handler fallback) : fallback_(std::move(fallback)) {
    for (auto& route : routes) {
        auto target = parse_target(route.pattern);
        if (!target) throw std::logic_error("not a route pattern: " + route.pattern);
        entries_.push_back({std::move(route), std::move(target->segments)});
    }
}

Router::Found Router::find(Request& request) const {
    const Method wanted = request.method == Method::head ? Method::get : request.method;
    std::vector<Method> others;
    for (const auto& entry : entries_) {
        auto parameters = match(entry.segments, request.segments);
        if (!parameters) continue;
        if (entry.route.method != wanted) {
            others.push_back(entry.route.method);
            continue;
        }
        request.parameters = std::move(*parameters);
        if (const auto* handler = std::get_if<Handler>(&entry.route.handler)) return handler;
        return &std::get<WebSocketHandler>(entry.route.handler);
    }
    if (others.empty() && fallback_) {
        if (wanted == Method::get) return &fallback_;
        others.push_back(Method::get);
    }
    if (others.empty()) return problem(404, "there is nothing at this address");
    Response response = problem(405, "this address does not know that method");
    response.headers.push_back({"Allow", allow_list(others)});
    return response;
}

}  // namespace kinectlab::net
