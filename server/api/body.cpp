#include "server/api/body.hpp"

#include <charconv>
#include <ctime>

#include "pipeline/core/nearest_name.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

constexpr const char* kTimeCure = "give a time such as 2026-11-22T09:00:00Z";

std::optional<int> digits(const std::string& text, std::size_t at, std::size_t count) {
    int value = 0;
    if (at + count > text.size()) return std::nullopt;
    for (std::size_t i = at; i < at + count; ++i) {
        if (text[i] < '0' || text[i] > '9') return std::nullopt;
        value = 10 * value + (text[i] - '0');
    }
    return value;
}

/// Seconds east of UTC from "Z", "+01:00" or "-05:30".
std::optional<int> parse_offset(const std::string& text) {
    if (text == "Z" || text == "z") return 0;
    if (text.size() != 6 || (text[0] != '+' && text[0] != '-') || text[3] != ':') {
        return std::nullopt;
    }
    const auto hours = digits(text, 1, 2);
    const auto minutes = digits(text, 4, 2);
    if (!hours || !minutes || *hours > 23 || *minutes > 59) return std::nullopt;
    const int seconds = *hours * 3600 + *minutes * 60;
    return text[0] == '-' ? -seconds : seconds;
}

}  // namespace

Result<json> read_body(const net::Request& request) {
    const auto type = request.header("Content-Type").value_or("");
    if (type.substr(0, type.find(';')) != "application/json") {
        return fail(
            ErrorCode::bad_data,
            "Content-Type",
            type.empty() ? "is missing" : "is " + std::string(type.substr(0, 60)),
            "send JSON with Content-Type: application/json"
        );
    }
    auto body = experiments::parse_json(request.body, "body");
    if (body && !body->is_object()) {
        return fail(
            ErrorCode::invalid_argument,
            "body",
            std::string("is of type ") + body->type_name(),
            "send a JSON object"
        );
    }
    return body;
}

std::optional<TimeNs> parse_time(const std::string& text) {
    const auto year = digits(text, 0, 4);
    const auto month = digits(text, 5, 2);
    const auto day = digits(text, 8, 2);
    const auto hour = digits(text, 11, 2);
    const auto minute = digits(text, 14, 2);
    const auto second = digits(text, 17, 2);
    if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
    const bool marks = text[4] == '-' && text[7] == '-' && (text[10] == 'T' || text[10] == 't') &&
                       text[13] == ':' && text[16] == ':';
    if (!marks || *hour > 23 || *minute > 59 || *second > 59) return std::nullopt;
    const std::chrono::year_month_day date{
        std::chrono::year(*year),
        std::chrono::month(static_cast<unsigned>(*month)),
        std::chrono::day(static_cast<unsigned>(*day))};
    // Beyond these years nanoseconds do not fit into 64 bits.
    if (!date.ok() || *year < 1970 || *year > 2200) return std::nullopt;

    std::size_t at = 19;
    TimeNs fraction = 0;
    if (at < text.size() && text[at] == '.') {
        TimeNs unit = kNsPerSecond / 10;
        for (++at; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at) {
            fraction += unit * (text[at] - '0');
            unit /= 10;
        }
    }
    const auto offset = parse_offset(text.substr(at));
    if (!offset) return std::nullopt;
    const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
    const std::int64_t seconds =
        days * 86400 + *hour * 3600 + *minute * 60 + *second - std::int64_t{*offset};
    return seconds * kNsPerSecond + fraction;
}

TimeNs read_time(ObjectReader& reader, const std::string& key) {
    const std::string text = reader.text(key);
    if (!reader.ok()) return 0;
    const auto time = parse_time(text);
    if (!time) reader.refuse(key, "is '" + text.substr(0, 40) + "'", kTimeCure);
    return time.value_or(0);
}

Result<std::optional<std::int64_t>> query_integer(
    const net::Request& request, const std::string& name, std::int64_t min, std::int64_t max
) {
    const auto found = request.query.find(name);
    if (found == request.query.end()) return std::nullopt;
    const std::string& text = found->second;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    if (whole && value >= min && value <= max) return value;
    return fail(
        ErrorCode::invalid_argument,
        name,
        "is '" + text.substr(0, 40) + "'",
        "give a whole number from " + std::to_string(min) + " to " + std::to_string(max)
    );
}

Result<std::optional<TimeNs>> query_time(const net::Request& request, const std::string& name) {
    const auto found = request.query.find(name);
    if (found == request.query.end()) return std::nullopt;
    const auto time = parse_time(found->second);
    if (time) return time;
    return fail(
        ErrorCode::invalid_argument, name, "is '" + found->second.substr(0, 40) + "'", kTimeCure
    );
}

Result<bool> query_flag(const net::Request& request, const std::string& name) {
    const auto found = request.query.find(name);
    if (found == request.query.end() || found->second == "false") return false;
    if (found->second == "true") return true;
    return fail(
        ErrorCode::invalid_argument,
        name,
        "is '" + found->second.substr(0, 40) + "'",
        "give true or false"
    );
}

Result<void> check_query(const net::Request& request, const std::vector<std::string>& names) {
    for (const auto& [name, value] : request.query) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        return fail(
            ErrorCode::invalid_argument,
            name.substr(0, 40),
            "is no parameter of this address",
            names.empty() ? "leave it out" : did_you_mean(name, names)
        );
    }
    if (!request.repeated.empty()) {
        return fail(
            ErrorCode::invalid_argument,
            request.repeated.substr(0, 40),
            "stands in the address twice",
            "give it once"
        );
    }
    return {};
}

std::optional<std::int64_t> parse_id(const std::string& text) {
    std::int64_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc() || end != text.data() + text.size() || id <= 0) return std::nullopt;
    return id;
}

}  // namespace kinectlab::api
