#include "server/experiments/trajectory_table.hpp"

#include <algorithm>
#include <cmath>

#include "server/experiments/table_columns.hpp"
#include "server/experiments/table_text.hpp"
#include "server/experiments/table_units.hpp"

namespace kinectlab::experiments {
namespace {

constexpr std::size_t kFewestRows = 8;
constexpr std::size_t kMostRows = 2'000'000;
constexpr std::size_t kRowsThatTellColumns = 9;
constexpr double kLeastSigma = 1e-5;          // m
constexpr double kOffPlaneSigma = 5e-3;       // m
constexpr long double kMostSeconds = 1e8L;    // from first to last: three years
constexpr long double kMostOffset = 9.1e18L;  // ns: what TimeNs holds, less three years

tl::unexpected<Error> bad(const std::string& name, const std::string& what, std::string cure) {
    return fail(ErrorCode::bad_data, name, what, std::move(cure));
}

/// The standard uncertainty of one coordinate: the scatter of third differences of evenly spaced
/// rows, which a smooth path hardly has; median, so that outliers do not tell.
double scatter_of(const std::vector<MotionSample>& samples, Eigen::Index axis) {
    std::vector<double> differences;
    for (std::size_t i = 3; i < samples.size(); ++i) {
        std::array<double, 4> p{};
        bool whole = true;
        double shortest = 1e300, longest = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& sample = samples[i - 3 + k];
            whole = whole && sample.status == TrackStatus::tracked;
            p[k] = sample.p_lab[axis];
            if (k == 0) continue;
            const auto gap = static_cast<double>(sample.t - samples[i - 4 + k].t);
            shortest = std::min(shortest, gap), longest = std::max(longest, gap);
        }
        if (!whole || longest > 1.1 * shortest) continue;
        differences.push_back(std::abs(p[3] - 3.0 * p[2] + 3.0 * p[1] - p[0]));
    }
    if (differences.empty()) return 1e-3;
    auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::nth_element(differences.begin(), middle, differences.end());
    return std::max(kLeastSigma, *middle / 0.6745 / std::sqrt(20.0));  // 1 + 9 + 9 + 1
}

void give_covariances(Trajectory& trajectory, bool flat) {
    Eigen::Vector3d sigma;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
        sigma[axis] = flat && axis == 1 ? kOffPlaneSigma : scatter_of(trajectory.samples, axis);
    for (auto& sample : trajectory.samples)
        sample.covariance.topLeftCorner<3, 3>() = sigma.cwiseAbs2().asDiagonal();
}

struct Rows {
    std::vector<TableLine> lines;
    TableDialect dialect;
    TableColumns columns;
    std::string name;
};

struct Row {
    std::array<long double, 4> value{};  ///< t, x, y, z as they stand there
    bool has_point = false, has_comma = false;
};

Result<Row> row_of(const Rows& rows, std::size_t i, std::vector<std::string_view>& cells) {
    split_cells(rows.lines[i].text, rows.dialect.separator, cells);
    const std::string line = "line " + std::to_string(rows.lines[i].number);
    Row row;
    for (std::size_t k = 0; k < rows.columns.used(); ++k) {
        const auto at = rows.columns.at[k];
        if (at >= cells.size() && i + 1 == rows.lines.size())
            return bad(rows.name, line + " is cut off", "leave it away");
        const auto cell = at < cells.size() ? cells[at] : std::string_view();
        const auto number = number_in(cell, rows.dialect.decimal_comma);
        if (!number)
            return bad(
                rows.name,
                line + ": '" + std::string(cell.substr(0, 40)) + "' is no number",
                "write numbers, or leave the cell empty for a gap"
            );
        row.value[k] = *number;
        row.has_point = row.has_point || cell.find('.') != cell.npos;
        row.has_comma = row.has_comma || cell.find(',') != cell.npos;
    }
    if (!std::isfinite(row.value[0]))
        return bad(rows.name, line + " has no time", "give each row the time in s or ms");
    return row;
}

/// Whole nanoseconds, of which the first row's are taken off before they are rounded.
std::optional<TimeNs> time_of(long double t, long double first, const std::string& unit) {
    const long double ns = std::round(scale_of_unit(unit) * 1e9);
    const long double since = (t - first) * ns;
    if (!(std::abs(since) < kMostSeconds * 1e9L)) return std::nullopt;
    const long double offset = first * ns;
    return (std::abs(offset) < kMostOffset ? std::llround(offset) : 0) + std::llround(since);
}

Result<void> read_rows(const Rows& rows, std::size_t first, TrajectoryTable& table) {
    auto& samples = table.trajectory.samples;
    std::vector<std::string_view> cells;
    const auto& unit = rows.columns.unit;
    bool has_point = false, has_comma = false;
    long double start = 0.0L;
    for (std::size_t i = first; i < rows.lines.size(); ++i) {
        const auto row = row_of(rows, i, cells);
        if (!row) {
            for (std::size_t later = i + 1; later < rows.lines.size(); ++later)
                if (row_of(rows, later, cells)) return tl::unexpected(row.error());
            const std::size_t count = rows.lines.size() - i;
            table.warnings.push_back(
                "left out the table's last " +
                (count == 1 ? std::string("line") : std::to_string(count) + " lines") +
                ", cut off or no numbers, from line " + std::to_string(rows.lines[i].number) + " on"
            );
            return {};
        }
        const std::string line = "line " + std::to_string(rows.lines[i].number);
        has_point = has_point || row->has_point;
        has_comma = has_comma || row->has_comma;
        if (has_point && has_comma)
            return bad(
                rows.name,
                line + " has a decimal point where others have a comma, or the other way round",
                "write all numbers in one way, without separators of thousands"
            );
        if (samples.empty()) start = row->value[0];
        const auto t = time_of(row->value[0], start, unit[0]);
        if (!t)
            return bad(
                rows.name,
                line + ": the time is more than three years from the first",
                "give the time's unit with --units, such as t=ms or t=ns"
            );
        if (!samples.empty() && *t <= samples.back().t)
            return bad(rows.name, line + ": the time does not increase", "sort the rows by time");
        Eigen::Vector3d p;
        for (Eigen::Index k = 0; k < 3; ++k) {
            const auto at = static_cast<std::size_t>(k + 1);
            p[k] = static_cast<double>(row->value[at]) * scale_of_unit(unit[at]);
        }
        MotionSample sample;
        sample.t = *t;
        sample.p_lab = rows.columns.used() == 3 ? Eigen::Vector3d(p.x(), 0.0, p.y()) : p;
        sample.status = p.allFinite() ? TrackStatus::tracked : TrackStatus::lost;
        samples.push_back(sample);
    }
    return {};
}

std::string text_of_units(const TableColumns& columns) {
    std::string text;
    for (std::size_t i = 0; i < columns.used(); ++i)
        text += std::string(i == 0 ? "" : ", ") + "txyz"[i] + " in " + columns.unit[i] +
                (columns.unit_from_head[i] ? " (head)" : "");
    return text;
}

}  // namespace

Result<TrajectoryTable> read_trajectory_table(
    std::string_view bytes, const TableLayout& layout, const std::string& name
) {
    const std::string text = to_utf8(bytes);
    if (text.find('\0') != text.npos)
        return bad(name, "is no text in UTF-8", "save it as a table in UTF-8");
    const std::string rows_cure = "give a table with a row of numbers for each time";
    auto [lines, remark] = lines_of_table(text, kMostRows);
    if (lines.empty()) return bad(name, "is empty", rows_cure);
    if (lines.size() > kMostRows)
        return bad(name, "has more than 2,000,000 rows", "cut it into parts");
    const auto dialect = dialect_of(lines);
    if (!dialect) return bad(name, "has no row of numbers", rows_cure);

    std::vector<std::string_view> cells;
    std::string_view head;
    std::size_t first = 0, columns = 0;
    for (; first < lines.size(); ++first) {
        split_cells(lines[first].text, dialect->separator, cells);
        if (is_row_of_numbers(cells, dialect->decimal_comma)) break;
        if (cells.size() > 1) head = lines[first].text;
    }
    for (std::size_t i = first; i < std::min(lines.size(), first + kRowsThatTellColumns); ++i) {
        split_cells(lines[i].text, dialect->separator, cells);
        columns = std::max(columns, cells.size());
    }
    auto found = find_columns(layout, {head, remark}, *dialect, columns, name);
    if (!found) return tl::unexpected(found.error());
    const Rows rows{std::move(lines), *dialect, std::move(*found), name};

    TrajectoryTable table;
    table.trajectory.object = "bob";
    table.units = text_of_units(rows.columns);
    table.pixels = rows.columns.unit[1] == "px";
    table.trajectory.samples.reserve(rows.lines.size() - first);
    if (auto read = read_rows(rows, first, table); !read) return tl::unexpected(read.error());
    const std::size_t count = table.trajectory.samples.size();
    if (count < kFewestRows)
        return bad(
            name,
            "has " + std::to_string(count) + " rows",
            "give at least " + std::to_string(kFewestRows)
        );
    give_covariances(table.trajectory, rows.columns.used() == 3);
    return table;
}

}  // namespace kinectlab::experiments
