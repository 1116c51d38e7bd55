#include <algorithm>
#include <map>

#include "server/experiments/trajectory_table.hpp"

namespace kinectlab::experiments {
namespace {

constexpr std::string_view kMeanings = "txyz";

struct Pair {
    std::string name, value;
};

std::vector<Pair> pairs_of(std::string_view text) {
    std::vector<Pair> pairs;
    while (!text.empty()) {
        const auto comma = std::min(text.find(','), text.size());
        const auto word = text.substr(0, comma);
        const auto equals = std::min(word.find('='), word.size());
        pairs.push_back(
            {std::string(word.substr(0, equals)),
             equals == word.size() ? std::string() : std::string(word.substr(equals + 1))}
        );
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return pairs;
}

std::optional<std::size_t> meaning_of(const std::string& name) {
    if (name.empty()) return std::nullopt;
    const auto* const at = std::find(kMeanings.begin(), kMeanings.end(), name.front());
    if (name.size() != 1 || at == kMeanings.end()) return std::nullopt;
    return static_cast<std::size_t>(at - kMeanings.begin());
}

/// Metres (thousands of pixels) or seconds in one unit; nothing for a unit of something else.
std::optional<double> scale_of(const std::string& unit, bool is_time) {
    static const std::map<std::string, double, std::less<>> times{{"s", 1.0}, {"ms", 1e-3}};
    static const std::map<std::string, double, std::less<>> lengths{
        {"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"px", 1e-3}};
    const auto& known = is_time ? times : lengths;
    const auto found = known.find(unit);
    if (found == known.end()) return std::nullopt;
    return found->second;
}

tl::unexpected<Error> wrong(const char* option, const std::string& word, const std::string& cure) {
    return fail(ErrorCode::invalid_argument, option, "cannot use '" + word + "'", cure);
}

}  // namespace

Result<TableLayout> parse_table_layout(std::string_view columns, std::string_view units) {
    TableLayout layout;
    for (const auto& [name, value] : pairs_of(columns)) {
        const auto at = meaning_of(name);
        if (!at || value.empty())
            return wrong(
                "--columns",
                name + (value.empty() ? "" : "=" + value),
                "give the heads or numbers of the columns, such as t=Time,x=X,y=Y or t=1,x=2,y=3"
            );
        if (!layout.column[*at].empty()) return wrong("--columns", name, "name each one once");
        layout.column[*at] = value;
    }
    std::array<std::string, 4> unit;
    for (const auto& [name, value] : pairs_of(units)) {
        const auto at = meaning_of(name);
        if (value.empty()) {
            const auto scale = scale_of(name, false);
            if (!scale)
                return wrong(
                    "--units", name, "give m, cm, mm or px, or each one, such as t=ms,x=cm"
                );
            std::fill(layout.scale.begin() + 1, layout.scale.end(), *scale);
            std::fill(unit.begin() + 1, unit.end(), name);
            continue;
        }
        const auto scale = at ? scale_of(value, *at == 0) : std::nullopt;
        if (!scale)
            return wrong(
                "--units", name + "=" + value, "t takes s or ms; x, y and z take m, cm, mm or px"
            );
        layout.scale[*at] = *scale;
        unit[*at] = value;
    }
    const auto in_pixels = [&](std::size_t i) {
        return unit[i] == "px";
    };
    layout.pixels = in_pixels(1) || in_pixels(2) || in_pixels(3);
    if (layout.pixels && unit[3].empty()) layout.scale[3] = 1e-3;
    if (layout.pixels && !(in_pixels(1) && in_pixels(2) && (in_pixels(3) || unit[3].empty())))
        return wrong("--units", std::string(units), "give x, y and z all in px, or none");
    return layout;
}

}  // namespace kinectlab::experiments
