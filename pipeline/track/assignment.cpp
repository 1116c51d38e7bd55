#include "pipeline/track/assignment.hpp"

#include <algorithm>
#include <limits>

namespace kinectlab {

// Columns are counted from 1, column 0 being where a new row enters; after the real columns comes
// one "none" for each row.

Assignment::Assignment(std::size_t most_rows, std::size_t most_columns) {
    const std::size_t columns = most_columns + most_rows + 1;
    row_price_.reserve(most_rows + 1);
    for (auto* prices : {&column_price_, &slack_})
        prices->reserve(columns);
    row_of_.reserve(columns);
    came_from_.reserve(columns);
    reached_.reserve(columns);
    column_of_.reserve(most_rows);
}

double Assignment::cost_of(std::span<const double> cost, std::size_t row, std::size_t column)
    const {
    if (column > columns_) return none_cost_;
    const double price = cost[(row - 1) * columns_ + (column - 1)];
    // A little dearer than none at all, so that none is taken; finite, so that sums stay numbers.
    return price < none_cost_ ? price : 2.0 * none_cost_ + 1.0;
}

std::span<const int> Assignment::solve(
    std::span<const double> cost, std::size_t rows, std::size_t columns, double none_cost
) {
    columns_ = columns;
    all_columns_ = columns + rows;
    none_cost_ = none_cost;
    row_price_.assign(rows + 1, 0.0);
    column_price_.assign(all_columns_ + 1, 0.0);
    row_of_.assign(all_columns_ + 1, 0);
    came_from_.assign(all_columns_ + 1, 0);
    slack_.assign(all_columns_ + 1, 0.0);
    reached_.assign(all_columns_ + 1, 0);
    for (std::size_t row = 1; row <= rows; ++row)
        insert_row(cost, row);
    column_of_.assign(rows, kNone);
    for (std::size_t column = 1; column <= columns; ++column)
        if (row_of_[column] != 0) column_of_[row_of_[column] - 1] = static_cast<int>(column - 1);
    return column_of_;
}

/// One shortest augmenting path from the new row to a free column.
void Assignment::insert_row(std::span<const double> cost, std::size_t row) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    row_of_[0] = row;
    std::size_t at = 0;
    std::fill(slack_.begin(), slack_.end(), kFar);
    std::fill(reached_.begin(), reached_.end(), static_cast<unsigned char>(0));
    do {
        reached_[at] = 1;
        const std::size_t from = row_of_[at];
        double least = kFar;
        std::size_t next = 0;
        for (std::size_t column = 1; column <= all_columns_; ++column) {
            if (reached_[column] != 0) continue;
            const double reduced =
                cost_of(cost, from, column) - row_price_[from] - column_price_[column];
            if (reduced < slack_[column]) {
                slack_[column] = reduced;
                came_from_[column] = at;
            }
            if (slack_[column] < least) {
                least = slack_[column];
                next = column;
            }
        }
        for (std::size_t column = 0; column <= all_columns_; ++column) {
            if (reached_[column] != 0) {
                row_price_[row_of_[column]] += least;
                column_price_[column] -= least;
            } else {
                slack_[column] -= least;
            }
        }
        at = next;
    } while (row_of_[at] != 0);
    while (at != 0) {
        row_of_[at] = row_of_[came_from_[at]];
        at = came_from_[at];
    }
}

}  // namespace kinectlab
