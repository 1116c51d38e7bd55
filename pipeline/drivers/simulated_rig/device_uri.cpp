#include "pipeline/drivers/simulated_rig/device_uri.hpp"

#include <algorithm>
#include <charconv>
#include <string>

namespace kinectlab::simulated_rig {
namespace {

constexpr std::string_view kScheme = "sim://";

bool is_name(std::string_view name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '_';
    });
}

Result<void> read_option(std::string_view option, simulate::RigSettings& settings) {
    const std::size_t equals = option.find('=');
    const std::string_view key = option.substr(0, equals);
    const std::string_view value =
        equals == std::string_view::npos ? std::string_view() : option.substr(equals + 1);
    if (key == "seed") {
        const char* end = value.data() + value.size();
        const auto [stop, error] = std::from_chars(value.data(), end, settings.seed);
        if (error == std::errc() && stop == end) return {};
        return fail(
            ErrorCode::invalid_argument,
            "seed",
            "is \"" + std::string(value) + "\"",
            "give a whole number from 0 to 2^64 - 1"
        );
    }
    if (key == "noise") {
        const auto model = simulate::noise_model_named(value);
        if (!model) return tl::unexpected(model.error());
        settings.noise = *model;
        return {};
    }
    return fail(
        ErrorCode::invalid_argument,
        "uri",
        "has the unknown option \"" + std::string(key) + "\"",
        "use seed and noise"
    );
}

}  // namespace

Result<simulate::RigSettings> parse_uri(std::string_view uri) {
    if (!uri.starts_with(kScheme))
        return fail(ErrorCode::not_found, "uri", "is not of a simulated rig", "use sim://NAME");
    const std::string_view rest = uri.substr(kScheme.size());
    const std::size_t question = rest.find('?');
    if (!is_name(rest.substr(0, question)))
        return fail(
            ErrorCode::invalid_argument,
            "uri",
            "names no rig: \"" + std::string(uri) + "\"",
            "use sim://NAME with letters, digits, - and _"
        );
    simulate::RigSettings settings;
    if (question == std::string_view::npos) return settings;
    std::string_view options = rest.substr(question + 1);
    while (!options.empty()) {
        const std::size_t end = std::min(options.find('&'), options.size());
        if (auto ok = read_option(options.substr(0, end), settings); !ok)
            return tl::unexpected(ok.error());
        options.remove_prefix(std::min(end + 1, options.size()));
    }
    return settings;
}

}  // namespace kinectlab::simulated_rig
