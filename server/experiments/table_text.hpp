#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinectlab::experiments {

/// UTF-8 of what may be UTF-16 with its mark; without a mark itself.
[[nodiscard]] std::string to_utf8(std::string_view bytes);

struct TableLine {
    std::size_t number;
    std::string_view text;
};

struct TableLines {
    std::vector<TableLine> lines;  ///< without empty ones and those with #
    std::string_view remark;       ///< the last line with # above them, without the #
};

/// Lines end with LF, CR LF or CR alone. Stops after `most` of them.
[[nodiscard]] TableLines lines_of_table(std::string_view text, std::size_t most);

struct TableDialect {
    char separator = ',';
    bool decimal_comma = false;  ///< may stand: the comma separates nothing

    bool operator==(const TableDialect&) const = default;
};

/// That of most of the last rows of numbers: heads and remarks stand at the top, a cut-off line or
/// text may stand at the end. Nothing where no line is a row of numbers.
[[nodiscard]] std::optional<TableDialect> dialect_of(const std::vector<TableLine>& lines);

/// The cells still have their quotes, which may enclose separators. Spaces may stand many in a row;
/// other separators enclose empty cells.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);

/// Without blanks and quotes around.
[[nodiscard]] std::string_view bare_cell(std::string_view cell);

/// Nothing for what is no number; NaN for a cell without one. Of the precision that nanoseconds
/// since 1970 need. In quotes a decimal comma may stand in any dialect.
[[nodiscard]] std::optional<long double> number_in(std::string_view cell, bool decimal_comma);

/// A number first, and another or a gap in one of the other cells.
[[nodiscard]] bool is_row_of_numbers(
    const std::vector<std::string_view>& cells, bool decimal_comma
);

}  // namespace kinectlab::experiments
