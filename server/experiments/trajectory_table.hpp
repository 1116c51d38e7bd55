#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab::experiments {

/// Which columns of a table hold what, and in which units.
struct TableLayout {
    /// Of t, x, y, z: a column's name as its head says it, or its number from 1; empty: the one
    /// that is called so. Without z the motion is two-dimensional.
    std::array<std::string, 4> column;
    std::array<std::string, 4> unit;  ///< empty: as the head says, else s and m

    bool operator==(const TableLayout&) const = default;
};

/// "t=Time,x=X,y=Y" or "t=1,x=2,y=3" and "t=ms,x=cm,y=cm", or one unit of length for all; both may
/// be empty. Errors name --columns or --units: a column of no known meaning or given twice, an
/// unknown unit.
[[nodiscard]] Result<TableLayout> parse_table_layout(
    std::string_view columns, std::string_view units
);

struct TrajectoryTable {
    Trajectory trajectory;
    std::string units;    ///< "t in ms, x in cm, y in cm", with "(head)" after those found there
    bool pixels = false;  ///< of unknown size: a thousand count as a metre
    std::vector<std::string> warnings;
};

/// Positions that another program wrote, e.g. Tracker, phyphox or a logger. Cells are separated by
/// tab, semicolon, comma or spaces; numbers have a point or, where the comma separates nothing or
/// in quotes, a comma. Lines before the first row of numbers are its head; lines with # are passed
/// over, and what is no row of numbers after the last one, with a warning. Of two dimensions x goes
/// to the right and y up, and the motion is taken to stay within 5 mm of that plane; of three z
/// goes up. An empty cell or NaN makes the row a gap. Times may count from any moment; one that
/// nanoseconds since 1970 cannot hold counts from the first row. The positions' uncertainty is what
/// they scatter about a smooth path, at least 10 µm.
/// Errors (bad_data, with the line): no such column, an unknown unit in its head, what is no
/// number, times that do not increase, fewer than 8 rows, more than 2,000,000.
[[nodiscard]] Result<TrajectoryTable> read_trajectory_table(
    std::string_view bytes, const TableLayout& layout, const std::string& name
);

}  // namespace kinectlab::experiments
