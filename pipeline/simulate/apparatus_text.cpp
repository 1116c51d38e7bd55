#include "pipeline/simulate/apparatus_text.hpp"

#include <charconv>

namespace kinectlab::simulate {
namespace {

/// Takes the next word off the text; empty at the end.
std::string_view next_word(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    return word;
}

tl::unexpected<Error> refuse(std::string_view word, std::string message) {
    return fail(
        ErrorCode::invalid_argument,
        std::string(word.substr(0, 60)),
        std::move(message),
        "give a name and then NAME=VALUE with spaces between, e.g. pendulum length_m=0.7"
    );
}

}  // namespace

std::string to_text(const ApparatusSettings& settings) {
    std::string text = settings.name;
    for (const auto& [name, value] : settings.parameters)
        text += " " + name + "=" + shortest_text(value);
    return text;
}

Result<ApparatusSettings> parse_apparatus(std::string_view text) {
    ApparatusSettings settings;
    settings.name = next_word(text);
    if (settings.name.empty() || settings.name.find('=') != std::string::npos)
        return refuse(settings.name, "is no apparatus");
    for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
        const std::size_t equals = word.find('=');
        if (equals == std::string_view::npos || equals == 0) return refuse(word, "sets nothing");
        const std::string_view number = word.substr(equals + 1);
        const char* end = number.data() + number.size();
        double value = 0.0;
        const auto read = std::from_chars(number.data(), end, value);
        if (read.ec != std::errc() || read.ptr != end) return refuse(word, "is no number");
        if (!settings.parameters.emplace(word.substr(0, equals), value).second)
            return refuse(word, "is there twice");
    }
    return settings;
}

}  // namespace kinectlab::simulate
