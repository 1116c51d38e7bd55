#include <algorithm>

#include "server/experiments/table_units.hpp"
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
    for (const auto& [name, value] : pairs_of(units)) {
        const auto at = meaning_of(name);
        if (value.empty()) {
            const auto unit = known_unit(name, false);
            if (!unit)
                return wrong(
                    "--units", name, "give m, cm, mm, in or px, or each one, such as t=ms,x=cm"
                );
            std::fill(layout.unit.begin() + 1, layout.unit.end(), *unit);
            continue;
        }
        const auto unit = at ? known_unit(value, *at == 0) : std::nullopt;
        if (!unit) return wrong("--units", name + "=" + value, kUnitsOfTables);
        layout.unit[*at] = *unit;
    }
    return layout;
}

}  // namespace kinectlab::experiments
