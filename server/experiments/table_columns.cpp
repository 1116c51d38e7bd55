#include "server/experiments/table_columns.hpp"

#include <algorithm>
#include <charconv>

#include "server/experiments/table_units.hpp"

namespace kinectlab::experiments {
namespace {

constexpr std::array<const char*, 4> kNames{"t", "x", "y", "z"};
constexpr std::size_t kMostShown = 200;  // characters of a head in an error

tl::unexpected<Error> bad(const std::string& name, const std::string& what, std::string cure) {
    return fail(ErrorCode::bad_data, name, what, std::move(cure));
}

/// Where spaces separate, "x (cm)" falls into two that belong together.
std::vector<std::string> split_head(std::string_view line, char separator) {
    std::vector<std::string_view> cells;
    split_cells(line, separator, cells);
    std::vector<std::string> heads;
    bool open = false;
    for (const auto cell : cells) {
        const bool opens = cell.starts_with('(') || cell.starts_with('[');
        if (separator == ' ' && !heads.empty() && (open || opens)) {
            heads.back() += ' ' + std::string(cell);
        } else {
            heads.emplace_back(cell);
        }
        const auto bracket = cell.find_last_of("()[]");
        if (bracket != cell.npos) open = cell[bracket] == '(' || cell[bracket] == '[';
    }
    return heads;
}

/// By what separates the rows, or else by what gives as many heads as they have cells.
std::vector<TableHead> heads_of(std::string_view line, char separator, std::size_t columns) {
    if (line.empty()) return {};
    auto best = split_head(line, separator);
    for (const char other : {'\t', ';', ',', ' '}) {
        if (best.size() == columns) break;
        if (auto heads = split_head(line, other); heads.size() == columns) best = std::move(heads);
    }
    while (best.size() > columns && best.back().empty())
        best.pop_back();
    std::vector<TableHead> heads;
    for (const auto& head : best)
        heads.push_back(parse_head(head));
    return heads;
}

/// kNoColumn where there is none of that name or number.
std::size_t find_column(
    const std::string& wanted, const std::vector<TableHead>& heads, std::size_t columns
) {
    std::size_t number = 0;
    const auto* end = wanted.data() + wanted.size();
    const auto [stop, code] = std::from_chars(wanted.data(), end, number);
    if (code == std::errc() && stop == end)
        return number >= 1 && number <= columns ? number - 1 : kNoColumn;
    const TableHead want = parse_head(wanted);
    for (std::size_t i = 0; i < heads.size(); ++i)
        if (heads[i].whole == want.whole) return i;
    for (std::size_t i = 0; i < heads.size(); ++i)
        if (heads[i].name == want.name) return i;
    return kNoColumn;
}

tl::unexpected<Error> no_column(
    const std::string& wanted,
    const std::vector<TableHead>& heads,
    std::size_t columns,
    const std::string& name
) {
    std::string all;
    for (const auto& head : heads)
        all += (all.empty() ? "" : ", ") + head.name;
    if (all.size() > kMostShown) all = all.substr(0, kMostShown) + "…";
    const std::string cells = std::to_string(columns);
    const std::string cure = "name them with --columns, such as t=1,x=2,y=3";
    if (heads.size() > columns)
        return bad(
            name,
            "has " + std::to_string(heads.size()) + " heads over " + cells + " columns: " + all,
            cure
        );
    return bad(
        name,
        "has no column '" + wanted + "'; it has " + cells +
            (heads.empty() ? " without heads" : ": " + all),
        cure
    );
}

/// That of --units goes before that of the head.
Result<void> find_unit(
    TableColumns& found,
    std::size_t i,
    const TableLayout& layout,
    const std::vector<TableHead>& heads,
    const std::string& name
) {
    found.unit[i] = layout.unit[i];
    if (!found.unit[i].empty() || found.at[i] >= heads.size()) return {};
    const auto& head = heads[found.at[i]];
    if (head.unit.empty()) return {};
    const auto unit = known_unit(head.unit, i == 0);
    if (!unit)
        return bad(
            name,
            "column '" + head.whole.substr(0, kMostShown) + "' has the unit '" +
                head.unit.substr(0, kMostShown) + "', which is not one for " + kNames[i],
            std::string("say it with --units, such as ") + (i == 0 ? "t=s" : "x=cm,y=cm") + "; " +
                kUnitsOfTables
        );
    found.unit[i] = *unit;
    found.unit_from_head[i] = true;
    return {};
}

/// Without any unit a length is in metres, or in pixels where --units says so of the others.
Result<void> fill_units(TableColumns& found, const std::string& name) {
    const auto is_pixels = [](const std::string& unit) {
        return unit == "px";
    };
    if (found.unit[0].empty()) found.unit[0] = "s";
    const auto begin = found.unit.begin() + 1;
    const auto end = found.unit.begin() + static_cast<std::ptrdiff_t>(found.used());
    const bool some_from_head =
        std::count(found.unit_from_head.begin() + 1, found.unit_from_head.end(), true) > 0;
    const bool px = std::any_of(begin, end, is_pixels);
    for (std::size_t i = 1; i < found.used(); ++i) {
        if (!found.unit[i].empty()) continue;
        if (some_from_head)
            return bad(
                name,
                std::string("says a unit in the head of other places but none of ") + kNames[i],
                "say it with --units, such as x=cm,y=cm"
            );
        found.unit[i] = i == 3 && px ? "px" : "m";
    }
    if (px && !std::all_of(begin, end, is_pixels))
        return bad(
            name, "has some places in px and some not", "give x, y and z all in px with --units"
        );
    return {};
}

}  // namespace

Result<TableColumns> find_columns(
    const TableLayout& layout,
    const TableTop& top,
    const TableDialect& dialect,
    std::size_t columns,
    const std::string& name
) {
    auto heads = heads_of(top.head, dialect.separator, columns);
    if (heads.empty()) {
        heads = heads_of(top.remark, dialect.separator, columns);
        if (heads.size() != columns) heads.clear();
    }
    // With more heads than columns none can be told by its name.
    const auto named = heads.size() > columns ? std::vector<TableHead>{} : heads;
    TableColumns found;
    for (std::size_t i = 0; i < 4; ++i) {
        const bool said = !layout.column[i].empty();
        const std::string wanted = said ? layout.column[i] : kNames[i];
        found.at[i] = find_column(wanted, named, columns);
        if (found.at[i] == kNoColumn && !said && i == 0)
            found.at[i] = find_column("time", named, columns);
        if (found.at[i] == kNoColumn && (said || i < 3))
            return no_column(wanted, heads, columns, name);
        if (found.at[i] == kNoColumn) continue;
        if (auto unit = find_unit(found, i, layout, named, name); !unit)
            return tl::unexpected(unit.error());
    }
    if (auto filled = fill_units(found, name); !filled) return tl::unexpected(filled.error());
    return found;
}

}  // namespace kinectlab::experiments
