#pragma once

#include <limits>

#include "server/experiments/table_text.hpp"
#include "server/experiments/trajectory_table.hpp"

namespace kinectlab::experiments {

inline constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

/// Where t, x, y and z stand and in which known units; kNoColumn for a z that is not there.
struct TableColumns {
    std::array<std::size_t, 4> at{};
    std::array<std::string, 4> unit;
    std::array<bool, 4> unit_from_head{};

    [[nodiscard]] std::size_t used() const { return at[3] == kNoColumn ? 3 : 4; }
};

/// Lines above the rows of numbers, maybe empty.
struct TableTop {
    std::string_view head;
    std::string_view remark;  ///< after a #, as numpy writes heads; taken where it fits the columns
};

/// `columns` is how many cells the rows have. Errors
/// (bad_data): no such column, an unknown unit in its head, units that do not fit together.
[[nodiscard]] Result<TableColumns> find_columns(
    const TableLayout& layout,
    const TableTop& top,
    const TableDialect& dialect,
    std::size_t columns,
    const std::string& name
);

}  // namespace kinectlab::experiments
