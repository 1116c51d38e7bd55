#include "server/experiments/table_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace kinectlab::experiments {
namespace {

constexpr std::size_t kRowsThatVote = 9;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

void append_utf8(std::string& text, unsigned code) {
    const auto byte = [&](unsigned value) {
        text += static_cast<char>(value);
    };
    if (code < 0x80U) {
        byte(code);
    } else if (code < 0x800U) {
        byte(0xC0U | code >> 6U);
        byte(0x80U | (code & 0x3FU));
    } else {
        byte(0xE0U | code >> 12U);
        byte(0x80U | (code >> 6U & 0x3FU));
        byte(0x80U | (code & 0x3FU));
    }
}

/// "0,1 2,5" has decimal commas, "0.1, 2.5" has not.
TableDialect dialect_of(std::string_view line) {
    for (const char separator : {'\t', ';'})
        if (line.find(separator) != line.npos) return {separator, true};
    if (line.find(',') == line.npos) return {' ', true};
    std::vector<std::string_view> cells;
    split_cells(line, ' ', cells);
    const bool whole = std::all_of(cells.begin(), cells.end(), [](std::string_view cell) {
        return number_in(cell, true).has_value();
    });
    return cells.size() > 1 && whole ? TableDialect{' ', true} : TableDialect{',', false};
}

/// A double where that is exact: reading a long double takes ten times as long.
template <typename Number>
std::optional<long double> parsed(const std::string& plain) {
    Number value = 0;
    const auto* end = plain.data() + plain.size();
    const auto [stop, code] = std::from_chars(plain.data(), end, value);
    if (code != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

}  // namespace

std::string to_utf8(std::string_view bytes) {
    const bool little = bytes.starts_with("\xFF\xFE");
    if (!little && !bytes.starts_with("\xFE\xFF"))
        return std::string(bytes.substr(bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0));
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        const auto first = static_cast<unsigned char>(bytes[i]);
        const auto second = static_cast<unsigned char>(bytes[i + 1]);
        append_utf8(text, little ? second * 256U + first : first * 256U + second);
    }
    return text;
}

TableLines lines_of_table(std::string_view text, std::size_t most) {
    TableLines found;
    for (std::size_t number = 1; !text.empty() && found.lines.size() <= most; ++number) {
        const auto end = std::min(text.find_first_of("\r\n"), text.size());
        auto line = text.substr(0, end);
        const bool pair = text.substr(end).starts_with("\r\n");
        text.remove_prefix(std::min(end + (pair ? 2 : 1), text.size()));
        while (!line.empty() && is_blank(line.back()))
            line.remove_suffix(1);
        if (line.empty()) continue;
        if (line.front() != '#') {
            found.lines.push_back({number, line});
        } else if (found.lines.empty()) {
            found.remark = line.substr(1);
        }
    }
    return found;
}

std::optional<TableDialect> dialect_of(const std::vector<TableLine>& lines) {
    std::vector<TableDialect> votes;
    std::vector<std::string_view> cells;
    for (auto line = lines.rbegin(); line != lines.rend() && votes.size() < kRowsThatVote; ++line) {
        const auto dialect = dialect_of(line->text);
        split_cells(line->text, dialect.separator, cells);
        if (is_row_of_numbers(cells, dialect.decimal_comma)) votes.push_back(dialect);
    }
    if (votes.empty()) return std::nullopt;
    return *std::max_element(votes.begin(), votes.end(), [&](const auto& a, const auto& b) {
        return std::count(votes.begin(), votes.end(), a) <
               std::count(votes.begin(), votes.end(), b);
    });
}

void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
    cells.clear();
    while (true) {
        while (!line.empty() &&
               (line.front() == ' ' || (separator != '\t' && is_blank(line.front()))))
            line.remove_prefix(1);
        const auto closed = line.starts_with('"') ? line.find('"', 1) : line.npos;
        const auto end = line.find(separator, closed == line.npos ? 0 : closed);
        auto cell = line.substr(0, end);
        while (!cell.empty() && is_blank(cell.back()))
            cell.remove_suffix(1);
        cells.push_back(cell);
        if (end == line.npos) return;
        line.remove_prefix(end + 1);
    }
}

std::string_view bare_cell(std::string_view cell) {
    const auto around = [](char c) {
        return is_blank(c) || c == '"' || c == '\'';
    };
    while (!cell.empty() && around(cell.front()))
        cell.remove_prefix(1);
    while (!cell.empty() && around(cell.back()))
        cell.remove_suffix(1);
    return cell;
}

std::optional<long double> number_in(std::string_view cell, bool decimal_comma) {
    const bool quoted = cell.starts_with('"');
    cell = bare_cell(cell);
    if (cell.empty() || cell == "NaN" || cell == "nan" || cell == "-")
        return std::numeric_limits<long double>::quiet_NaN();
    std::string plain(cell.front() == '+' ? cell.substr(1) : cell);
    if (plain.empty()) return std::nullopt;
    if (decimal_comma || quoted) {
        const auto comma = plain.find(',');
        const bool both = comma != plain.npos && plain.find('.') != plain.npos;
        if (both || plain.back() == ',') return std::nullopt;
        std::replace(plain.begin(), plain.end(), ',', '.');
    }
    constexpr std::size_t kDigitsOfDouble = 15;
    return plain.size() <= kDigitsOfDouble ? parsed<double>(plain) : parsed<long double>(plain);
}

bool is_row_of_numbers(const std::vector<std::string_view>& cells, bool decimal_comma) {
    if (cells.size() < 2) return false;
    const auto first = number_in(cells[0], decimal_comma);
    return first && std::isfinite(*first) &&
           std::any_of(cells.begin() + 1, cells.end(), [&](std::string_view cell) {
               return number_in(cell, decimal_comma).has_value();
           });
}

}  // namespace kinectlab::experiments
