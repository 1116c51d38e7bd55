#include "server/lab/utc.hpp"

#include <array>
#include <ctime>

namespace kinectlab::lab {
namespace {

constexpr TimeNs floor_div(TimeNs a, TimeNs b) {
    return a / b - (a % b < 0 ? 1 : 0);
}

}  // namespace

std::string to_rfc3339(TimeNs t) {
    const auto seconds = static_cast<std::time_t>(floor_div(t, kNsPerSecond));
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    std::array<char, 32> text{};
    const std::size_t length =
        std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return {text.data(), length};
}

std::string span_text(TimeNs span) {
    const TimeNs seconds = floor_div(span, kNsPerSecond);
    if (seconds < 90) return std::to_string(seconds) + " s";
    const TimeNs minutes = (seconds + 30) / 60;
    if (minutes < 120) return std::to_string(minutes) + " min";
    const TimeNs hours = (minutes + 30) / 60;
    if (hours < 48) return std::to_string(hours) + " h";
    return std::to_string((hours + 12) / 24) + " days";
}

}  // namespace kinectlab::lab
