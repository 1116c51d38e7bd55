#include "server/net/message.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace kinectlab::net {
namespace {

constexpr std::array<std::pair<Method, std::string_view>, 8> kMethods{{
    {Method::get, "GET"},
    {Method::head, "HEAD"},
    {Method::post, "POST"},
    {Method::put, "PUT"},
    {Method::patch, "PATCH"},
    {Method::del, "DELETE"},
    {Method::options, "OPTIONS"},
    {Method::other, "?"},
}};

constexpr std::array<std::pair<int, std::string_view>, 19> kReasons{{
    {200, "OK"},
    {201, "Created"},
    {204, "No Content"},
    {304, "Not Modified"},
    {400, "Bad Request"},
    {401, "Unauthorized"},
    {403, "Forbidden"},
    {404, "Not Found"},
    {405, "Method Not Allowed"},
    {409, "Conflict"},
    {413, "Content Too Large"},
    {415, "Unsupported Media Type"},
    {421, "Misdirected Request"},
    {422, "Unprocessable Content"},
    {426, "Upgrade Required"},
    {429, "Too Many Requests"},
    {431, "Request Header Fields Too Large"},
    {500, "Internal Server Error"},
    {503, "Service Unavailable"},
}};

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_name(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return lower(x) == lower(y);
    });
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    c = lower(c);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%') {
            if (i + 2 >= text.size()) return std::nullopt;
            const int high = hex_digit(text[i + 1]);
            const int low = hex_digit(text[i + 2]);
            if (high < 0 || low < 0) return std::nullopt;
            out.push_back(static_cast<char>(high * 16 + low));
            i += 2;
        } else {
            out.push_back(plus_is_space && text[i] == '+' ? ' ' : text[i]);
        }
    }
    return out;
}

/// Calls `use` with each part of `text` between separators; stops when it returns false.
template <class Use>
bool split(std::string_view text, char separator, Use use) {
    while (true) {
        const auto end = text.find(separator);
        if (!use(text.substr(0, end))) return false;
        if (end == std::string_view::npos) return true;
        text.remove_prefix(end + 1);
    }
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
        text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
        text.remove_suffix(1);
    return text;
}

}  // namespace

std::string_view to_text(Method method) {
    for (const auto& [value, name] : kMethods) {
        if (value == method) return name;
    }
    return "?";
}

std::string_view reason_phrase(int status) {
    for (const auto& [value, phrase] : kReasons) {
        if (value == status) return phrase;
    }
    return "Error";
}

std::optional<std::string_view> Request::header(std::string_view name) const {
    for (const auto& header : headers) {
        if (same_name(header.name, name)) return header.value;
    }
    return std::nullopt;
}

std::optional<std::string_view> Request::cookie(std::string_view name) const {
    for (const auto& header : headers) {
        if (!same_name(header.name, "Cookie")) continue;
        std::optional<std::string_view> found;
        split(header.value, ';', [&](std::string_view pair) {
            const auto equals = pair.find('=');
            if (equals == std::string_view::npos || trimmed(pair.substr(0, equals)) != name) {
                return true;
            }
            found = trimmed(pair.substr(equals + 1));
            return false;
        });
        if (found) return found;
    }
    return std::nullopt;
}

std::optional<Target> parse_target(std::string_view target) {
    if (target.empty() || target.front() != '/') return std::nullopt;
    const auto mark = target.find('?');
    Target parsed;
    parsed.path = target.substr(0, mark);

    const bool path_ok = split(std::string_view(parsed.path).substr(1), '/', [&](auto part) {
        auto segment = percent_decode(part, false);
        if (!segment || segment->find('\0') != std::string::npos) return false;
        parsed.segments.push_back(std::move(*segment));
        return true;
    });
    if (!path_ok) return std::nullopt;
    if (mark == std::string_view::npos) return parsed;

    const bool query_ok = split(target.substr(mark + 1), '&', [&](auto part) {
        if (part.empty()) return true;
        const auto equals = part.find('=');
        auto name = percent_decode(part.substr(0, equals), true);
        auto value = percent_decode(
            equals == std::string_view::npos ? std::string_view() : part.substr(equals + 1), true
        );
        if (!name || !value) return false;
        if (!parsed.query.try_emplace(*name, std::move(*value)).second) parsed.repeated = *name;
        return true;
    });
    if (!query_ok) return std::nullopt;
    return parsed;
}

Response problem(int status, std::string_view detail) {
    std::string body = R"({"type":"about:blank","title":")";
    body.append(reason_phrase(status)).append(R"(","status":)").append(std::to_string(status));
    body.append(R"(,"detail":")").append(detail).append("\"}");
    return {status, "application/problem+json", std::move(body), {{"Cache-Control", "no-store"}}};
}

}  // namespace kinectlab::net
