#include "pipeline/track/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

/// The least cost by trying everything.
double best_by_trying(
    const std::vector<double>& cost,
    std::size_t row,
    std::size_t rows,
    std::size_t columns,
    double none,
    std::vector<bool>& taken
) {
    if (row == rows) return 0.0;
    double best = none + best_by_trying(cost, row + 1, rows, columns, none, taken);
    for (std::size_t c = 0; c < columns; ++c) {
        const double price = cost[row * columns + c];
        if (taken[c] || !(price < none)) continue;
        taken[c] = true;
        best = std::min(best, price + best_by_trying(cost, row + 1, rows, columns, none, taken));
        taken[c] = false;
    }
    return best;
}

TEST(Assignment, IsAsCheapAsTheBestOfAll) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> price(-5.0, 20.0);
    Assignment assignment(5, 5);
    for (int trial = 0; trial < 500; ++trial) {
        const std::size_t rows = random() % 6, columns = random() % 6;
        std::vector<double> cost(rows * columns);
        for (auto& c : cost)
            c = price(random);
        constexpr double kNone = 10.0;
        const auto column_of = assignment.solve(cost, rows, columns, kNone);
        ASSERT_EQ(column_of.size(), rows);
        double sum = 0.0;
        std::vector<bool> taken(columns, false);
        for (std::size_t row = 0; row < rows; ++row) {
            if (column_of[row] == Assignment::kNone) {
                sum += kNone;
                continue;
            }
            const auto column = static_cast<std::size_t>(column_of[row]);
            ASSERT_FALSE(taken[column]) << "given twice";
            taken[column] = true;
            ASSERT_LT(cost[row * columns + column], kNone);
            sum += cost[row * columns + column];
        }
        std::vector<bool> free(columns, false);
        EXPECT_NEAR(sum, best_by_trying(cost, 0, rows, columns, kNone, free), 1e-9) << trial;
    }
}

TEST(Assignment, TakesNothingThatIsNoNumber) {
    Assignment assignment(2, 1);
    const std::vector cost{std::nan(""), std::numeric_limits<double>::infinity()};
    const auto column_of = assignment.solve(cost, 2, 1, 10.0);
    EXPECT_EQ(column_of[0], Assignment::kNone);
    EXPECT_EQ(column_of[1], Assignment::kNone);
}

}  // namespace
}  // namespace kinectlab
