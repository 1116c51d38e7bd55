#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kinectlab {

/// Who is who: the cheapest way to give each row (a name) one column (a thing seen) or none.
/// The Hungarian method with potentials (Kuhn 1955, Munkres 1957), O(rows² x columns). Keeps its
/// buffers: no allocation for up to the sizes given. Not thread-safe.
class Assignment {
public:
    Assignment(std::size_t most_rows, std::size_t most_columns);

    /// `cost` is row-major, rows x columns; a cost of `none_cost` or more, or NaN, is never taken,
    /// because to have no column costs that much. The column of each row, or kNone; valid until the
    /// next call.
    [[nodiscard]] std::span<const int> solve(
        std::span<const double> cost, std::size_t rows, std::size_t columns, double none_cost
    );

    static constexpr int kNone = -1;

private:
    void insert_row(std::span<const double> cost, std::size_t row);
    [[nodiscard]] double cost_of(std::span<const double> cost, std::size_t row, std::size_t column)
        const;

    std::size_t columns_ = 0, all_columns_ = 0;
    double none_cost_ = 0.0;
    std::vector<double> row_price_, column_price_, slack_;
    std::vector<std::size_t> row_of_, came_from_;
    std::vector<unsigned char> reached_;
    std::vector<int> column_of_;
};

}  // namespace kinectlab
