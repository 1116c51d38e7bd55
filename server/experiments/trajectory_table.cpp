#include "server/experiments/trajectory_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace kinectlab::experiments {
namespace {

constexpr std::size_t kFewestRows = 8;
constexpr std::size_t kMostRows = 2'000'000;
constexpr double kLeastSigma = 1e-5;     // m
constexpr double kOffPlaneSigma = 5e-3;  // m
constexpr double kMostSeconds = 1e8;     // three years
constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

struct Line {
    std::size_t number;
    std::string_view text;
};

std::vector<Line> lines_of(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::vector<Line> lines;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const auto end = std::min(text.find('\n'), text.size());
        auto line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        while (!line.empty() && is_blank(line.back()))
            line.remove_suffix(1);
        if (!line.empty() && line.front() != '#') lines.push_back({number, line});
    }
    return lines;
}

std::string_view trimmed(std::string_view word) {
    const auto around = [](char c) {
        return is_blank(c) || c == '"' || c == '\'';
    };
    while (!word.empty() && around(word.front()))
        word.remove_prefix(1);
    while (!word.empty() && around(word.back()))
        word.remove_suffix(1);
    return word;
}

/// Spaces may stand many in a row; other separators enclose empty cells.
void split(std::string_view line, char separator, std::vector<std::string_view>& cells) {
    cells.clear();
    while (true) {
        if (separator == ' ')
            while (!line.empty() && line.front() == ' ')
                line.remove_prefix(1);
        const auto end = line.find(separator);
        cells.push_back(trimmed(line.substr(0, end)));
        if (end == line.npos) return;
        line.remove_prefix(end + 1);
    }
}

/// Nothing for what is no number; NaN for a cell without one.
std::optional<double> number_in(std::string_view cell, bool decimal_comma) {
    if (cell.empty() || cell == "NaN" || cell == "nan" || cell == "-")
        return std::numeric_limits<double>::quiet_NaN();
    std::string plain(cell.front() == '+' ? cell.substr(1) : cell);
    if (decimal_comma) {
        const auto comma = plain.find(',');
        const bool both = comma != plain.npos && plain.find('.') != plain.npos;
        if (both || plain.back() == ',') return std::nullopt;
        std::replace(plain.begin(), plain.end(), ',', '.');
    }
    double value = 0.0;
    const auto* end = plain.data() + plain.size();
    const auto [stop, code] = std::from_chars(plain.data(), end, value);
    if (code != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

struct Dialect {
    char separator = ',';
    bool decimal_comma = false;  ///< may stand: the comma separates nothing
};

/// As the last line has it: heads and remarks stand at the top.
Dialect dialect_of(std::string_view line) {
    for (const char separator : {'\t', ';'})
        if (line.find(separator) != line.npos) return {separator, true};
    if (line.find(',') == line.npos) return {' ', true};
    // "0,1 2,5" has decimal commas, "0.1, 2.5" has not.
    std::vector<std::string_view> cells;
    split(line, ' ', cells);
    const bool whole = std::all_of(cells.begin(), cells.end(), [](std::string_view cell) {
        return number_in(cell, true).has_value();
    });
    return cells.size() > 1 && whole ? Dialect{' ', true} : Dialect{',', false};
}

std::string bare_name(std::string_view head) {
    const auto unit = std::min(head.find('('), head.find('['));
    std::string name(trimmed(head.substr(0, unit)));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return name;
}

/// kNoColumn where there is none of that name or number.
std::size_t find_column(
    const std::string& wanted, const std::vector<std::string>& heads, std::size_t columns
) {
    std::size_t number = 0;
    const auto* end = wanted.data() + wanted.size();
    const auto [stop, code] = std::from_chars(wanted.data(), end, number);
    if (code == std::errc() && stop == end)
        return number >= 1 && number <= columns ? number - 1 : kNoColumn;
    const std::string name = bare_name(wanted);
    for (std::size_t i = 0; i < heads.size(); ++i)
        if (heads[i] == name) return i;
    return kNoColumn;
}

tl::unexpected<Error> bad(const std::string& name, const std::string& what, std::string cure) {
    return fail(ErrorCode::bad_data, name, what, std::move(cure));
}

Result<std::array<std::size_t, 4>> find_columns(
    const TableLayout& layout,
    const std::vector<std::string>& heads,
    std::size_t columns,
    const std::string& name
) {
    constexpr std::array kNames{"t", "x", "y", "z"};
    std::array<std::size_t, 4> found{};
    for (std::size_t i = 0; i < 4; ++i) {
        const bool said = !layout.column[i].empty();
        const std::string wanted = said ? layout.column[i] : kNames[i];
        found[i] = find_column(wanted, heads, columns);
        if (found[i] == kNoColumn && !said && i == 0)
            found[i] = find_column("time", heads, columns);
        if (found[i] == kNoColumn && (said || i < 3)) {
            std::string all;
            for (const auto& head : heads)
                all += (all.empty() ? "" : ", ") + head;
            return bad(
                name,
                "has no column '" + wanted + "'; it has " + std::to_string(columns) +
                    (heads.empty() ? " without heads" : ": " + all),
                "name them with --columns, such as t=1,x=2,y=3"
            );
        }
    }
    return found;
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

MotionSample sample_at(double t_s, const Eigen::Vector3d& p_lab) {
    MotionSample sample;
    sample.t = std::llround(t_s * 1e9);
    sample.p_lab = p_lab;
    sample.status = p_lab.allFinite() ? TrackStatus::tracked : TrackStatus::lost;
    return sample;
}

void give_covariances(Trajectory& trajectory, bool flat) {
    Eigen::Vector3d sigma;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
        sigma[axis] = flat && axis == 1 ? kOffPlaneSigma : scatter_of(trajectory.samples, axis);
    for (auto& sample : trajectory.samples)
        sample.covariance.topLeftCorner<3, 3>() = sigma.cwiseAbs2().asDiagonal();
}

}  // namespace

Result<Trajectory> read_trajectory_table(
    std::string_view text, const TableLayout& layout, const std::string& name
) {
    const auto lines = lines_of(text);
    const std::string rows_cure = "give a table with a row of numbers for each time";
    if (lines.empty()) return bad(name, "is empty", rows_cure);
    if (lines.size() > kMostRows)
        return bad(name, "has more than 2,000,000 rows", "cut it into parts");
    const Dialect dialect = dialect_of(lines.back().text);

    std::vector<std::string_view> cells;
    std::vector<std::string> heads;
    std::size_t first = 0;
    for (; first < lines.size(); ++first) {
        split(lines[first].text, dialect.separator, cells);
        const bool numbers = cells.size() > 1 && !cells[0].empty() &&
                             number_in(cells[0], dialect.decimal_comma) &&
                             number_in(cells[1], dialect.decimal_comma);
        if (numbers) break;
        if (cells.size() > 1) {
            heads.clear();
            for (const auto& cell : cells)
                heads.push_back(bare_name(cell));
        }
    }
    if (first == lines.size()) return bad(name, "has no row of numbers", rows_cure);
    const auto columns = find_columns(layout, heads, cells.size(), name);
    if (!columns) return tl::unexpected(columns.error());
    const auto& [at_t, at_x, at_y, at_z] = *columns;
    const bool flat = at_z == kNoColumn;

    Trajectory trajectory;
    trajectory.object = "bob";
    trajectory.samples.reserve(lines.size() - first);
    for (std::size_t i = first; i < lines.size(); ++i) {
        split(lines[i].text, dialect.separator, cells);
        const std::string line = "line " + std::to_string(lines[i].number);
        std::array<double, 4> value{};
        for (std::size_t k = 0; k < (flat ? 3U : 4U); ++k) {
            const std::string_view cell =
                (*columns)[k] < cells.size() ? cells[(*columns)[k]] : std::string_view();
            const auto number = number_in(cell, dialect.decimal_comma);
            if (!number)
                return bad(
                    name,
                    line + ": '" + std::string(cell.substr(0, 40)) + "' is no number",
                    "write numbers, or leave the cell empty for a gap"
                );
            value[k] = *number * layout.scale[k];
        }
        if (!(std::abs(value[0]) < kMostSeconds))
            return bad(name, line + " has no time that makes sense", "give the time in s or ms");
        const Eigen::Vector3d p = flat ? Eigen::Vector3d(value[1], 0.0, value[2])
                                       : Eigen::Vector3d(value[1], value[2], value[3]);
        const auto sample = sample_at(value[0], p);
        if (!trajectory.samples.empty() && sample.t <= trajectory.samples.back().t)
            return bad(name, line + ": the time does not increase", "sort the rows by time");
        trajectory.samples.push_back(sample);
    }
    if (trajectory.samples.size() < kFewestRows)
        return bad(
            name,
            "has " + std::to_string(trajectory.samples.size()) + " rows",
            "give at least " + std::to_string(kFewestRows)
        );
    give_covariances(trajectory, flat);
    return trajectory;
}

}  // namespace kinectlab::experiments
