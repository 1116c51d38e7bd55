#include "pipeline/sensor/tum_lists.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <sstream>

#include "pipeline/sensor/file_bytes.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = 64U << 20U;
constexpr std::size_t kFractionDigits = 9;

bool is_digits(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

struct Line {
    int number = 0;
    std::vector<std::string> words;
};

Result<std::vector<Line>> read_lines(const fs::path& file) {
    std::vector<std::uint8_t> bytes;
    if (auto read = read_file(file, kMaxListBytes, bytes); !read)
        return tl::unexpected<Error>(read.error());
    std::istringstream stream(std::string(bytes.begin(), bytes.end()));
    std::vector<Line> lines;
    std::string text;
    for (int number = 1; std::getline(stream, text); ++number) {
        Line line{number, {}};
        std::istringstream words(text.substr(0, text.find('#')));
        for (std::string word; words >> word;)
            line.words.push_back(word);
        if (!line.words.empty()) lines.push_back(std::move(line));
    }
    return lines;
}

tl::unexpected<Error> wrong_line(
    const fs::path& list, int line, std::string message, std::string cure
) {
    return fail(
        ErrorCode::bad_data,
        list.string() + ":" + std::to_string(line),
        std::move(message),
        std::move(cure)
    );
}

// A list may come from anywhere; it must not make the program read other files of this machine.
bool stays_inside(const fs::path& folder, const fs::path& relative) {
    if (relative.is_absolute()) return false;
    if (std::any_of(relative.begin(), relative.end(), [](const auto& part) {
            return part == "..";
        }))
        return false;
    std::error_code code;
    const auto root = fs::weakly_canonical(folder, code);
    const auto target = fs::weakly_canonical(folder / relative, code);
    if (code) return false;
    return std::mismatch(root.begin(), root.end(), target.begin(), target.end()).first ==
           root.end();
}

}  // namespace

std::optional<TimeNs> parse_timestamp(std::string_view text) {
    const std::size_t point = std::min(text.find('.'), text.size());
    const std::string_view whole = text.substr(0, point);
    std::string fraction(text.substr(std::min(point + 1, text.size())));
    if (whole.empty() || whole.size() > 10 || !is_digits(whole) || !is_digits(fraction))
        return std::nullopt;
    if (fraction.size() > 40) return std::nullopt;
    fraction.resize(kFractionDigits, '0');
    const TimeNs seconds = std::stoll(std::string(whole));
    if (seconds >= std::numeric_limits<TimeNs>::max() / kNsPerSecond) return std::nullopt;
    return seconds * kNsPerSecond + std::stoll(fraction);
}

std::string format_timestamp(TimeNs t) {
    std::array<char, 40> text{};
    std::snprintf(
        text.data(),
        text.size(),
        "%lld.%09lld",
        static_cast<long long>(t / kNsPerSecond),
        static_cast<long long>(t % kNsPerSecond)
    );
    return text.data();
}

Result<std::vector<TumEntry>> read_tum_list(const fs::path& folder, const std::string& list) {
    const fs::path path = folder / list;
    auto lines = read_lines(path);
    if (!lines) return tl::unexpected<Error>(lines.error());
    std::vector<TumEntry> entries;
    for (const auto& [number, words] : *lines) {
        const auto t = parse_timestamp(words[0]);
        if (words.size() != 2 || !t) {
            return wrong_line(
                path,
                number,
                "is no line \"timestamp path\"",
                "give e.g. 1305031102.175304 depth/1.png"
            );
        }
        if (!entries.empty() && *t <= entries.back().t) {
            return wrong_line(
                path,
                number,
                "has the time " + words[0] + ", not after that of the line before",
                "give times that increase"
            );
        }
        if (!stays_inside(folder, words[1])) {
            return wrong_line(
                path,
                number,
                "leads out of the recording (itself or by a symbolic link): " +
                    words[1].substr(0, 200),
                "put the pictures themselves into " + folder.string()
            );
        }
        std::error_code code;
        if (!fs::is_regular_file(folder / words[1], code)) {
            return wrong_line(
                path,
                number,
                "names a file that is not there: " + words[1].substr(0, 200),
                "put the file there or take the line out"
            );
        }
        entries.push_back({*t, folder / words[1], number});
    }
    if (entries.empty()) {
        return fail(
            ErrorCode::bad_data,
            path.string(),
            "lists no pictures",
            "give one line \"timestamp path\" for each"
        );
    }
    return entries;
}

TimeNs median_step(const std::vector<TumEntry>& entries) {
    if (entries.size() < 2) return 0;
    std::vector<TimeNs> steps;
    for (std::size_t i = 1; i < entries.size(); ++i)
        steps.push_back(entries[i].t - entries[i - 1].t);
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

std::vector<std::optional<std::size_t>> pair_by_time(
    const std::vector<TumEntry>& depth, const std::vector<TumEntry>& colour
) {
    const TimeNs limit = depth.size() > 1 ? median_step(depth) : std::numeric_limits<TimeNs>::max();
    std::vector<std::optional<std::size_t>> pairs(depth.size());
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < depth.size() && !colour.empty(); ++i) {
        const auto distance = [&](std::size_t c) {
            return std::abs(colour[c].t - depth[i].t);
        };
        while (nearest + 1 < colour.size() && distance(nearest + 1) <= distance(nearest))
            ++nearest;
        if (distance(nearest) <= limit) pairs[i] = nearest;
    }
    return pairs;
}

Result<std::vector<TumPose>> read_groundtruth(const fs::path& folder) {
    const fs::path path = folder / "groundtruth.txt";
    auto lines = read_lines(path);
    if (!lines) return tl::unexpected<Error>(lines.error());
    std::vector<TumPose> poses;
    for (const auto& [number, words] : *lines) {
        const auto t = parse_timestamp(words[0]);
        std::array<double, 7> values{};
        bool fine = t.has_value() && words.size() == 8;
        for (std::size_t i = 0; fine && i < values.size(); ++i) {
            char* end = nullptr;
            values[i] = std::strtod(words[i + 1].c_str(), &end);
            fine = *end == '\0' && std::isfinite(values[i]);
        }
        if (!fine)
            return wrong_line(path, number, "is no pose", "give timestamp tx ty tz qx qy qz qw");
        poses.push_back(
            {*t,
             {values[0], values[1], values[2]},
             Eigen::Quaterniond(values[6], values[3], values[4], values[5]).normalized()}
        );
    }
    return poses;
}

}  // namespace kinectlab
