#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include "pipeline/sensor/pcd_file.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kMaxHeader = 16 * 1024;
constexpr std::size_t kMaxDataBytes = 512U << 20U;
constexpr std::size_t kMaxFields = 64;
constexpr int kMaxSide = 4096;
constexpr int kMaxCount = 4096;  // descriptors of a point, in one field

using Words = std::vector<std::string>;

std::optional<int> to_int(const std::string& word, int low, int high) {
    int value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool fine =
        code == std::errc() && end == word.data() + word.size() && value >= low && value <= high;
    return fine ? std::optional(value) : std::nullopt;
}

// Takes one header line; false if it makes no sense.
bool take_numbers(
    const Words& words, std::vector<PcdField>& fields, int PcdField::*member, int low, int high
) {
    if (words.size() != fields.size() + 1) return false;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto value = to_int(words[i + 1], low, high);
        if (!value) return false;
        fields[i].*member = *value;
    }
    return true;
}

bool take_types(const Words& words, std::vector<PcdField>& fields) {
    if (words.size() != fields.size() + 1) return false;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const std::string& word = words[i + 1];
        if (word != "F" && word != "I" && word != "U") return false;
        fields[i].type = word[0];
    }
    return true;
}

bool take_fields(const Words& words, std::vector<PcdField>& fields) {
    if (!fields.empty() || words.size() < 2 || words.size() > kMaxFields + 1) return false;
    for (std::size_t i = 1; i < words.size(); ++i)
        fields.push_back({words[i]});
    return true;
}

bool take_side(const Words& words, int& side) {
    const auto value = words.size() == 2 ? to_int(words[1], 0, 1 << 24) : std::nullopt;
    if (value) side = *value;
    return value.has_value();
}

bool take_data(const Words& words, PcdHeader::Data& data) {
    const std::string word = words.size() == 2 ? words[1] : "";
    if (word == "ascii") data = PcdHeader::Data::ascii;
    if (word == "binary") data = PcdHeader::Data::binary;
    if (word == "binary_compressed") data = PcdHeader::Data::binary_compressed;
    return word == "ascii" || word == "binary" || word == "binary_compressed";
}

bool take_line(const Words& words, PcdHeader& header) {
    const std::string& key = words[0];
    if (key == "FIELDS" || key == "COLUMNS") return take_fields(words, header.fields);
    if (key == "SIZE") return take_numbers(words, header.fields, &PcdField::size, 1, 8);
    if (key == "TYPE") return take_types(words, header.fields);
    if (key == "COUNT") return take_numbers(words, header.fields, &PcdField::count, 1, kMaxCount);
    if (key == "WIDTH") return take_side(words, header.width);
    if (key == "HEIGHT") return take_side(words, header.height);
    if (key == "DATA") return take_data(words, header.data);
    return key == "VERSION" || key == "VIEWPOINT" || key == "POINTS";
}

Result<PcdHeader> check(PcdHeader header, const std::string& name, PcdShape shape) {
    const auto bad = [&](std::string message, std::string cure) {
        return fail(ErrorCode::bad_data, name, std::move(message), std::move(cure));
    };
    if (header.width < 0 || header.height < 0)
        return bad("has no WIDTH or no HEIGHT", "give both in the header");
    const std::string size = std::to_string(header.width) + "x" + std::to_string(header.height);
    if (header.width == 0 || header.height == 0)
        return bad(
            "is empty: its header says " + size + " points",
            "give a cloud with points, or leave the file out"
        );
    const bool is_list = header.height == 1;
    if (is_list && shape == PcdShape::organised)
        return bad("is not organised: " + size, "give a cloud as the sensor took it, e.g. 640x480");
    if (!is_list && (header.width > kMaxSide || header.height > kMaxSide))
        return bad("is " + size, "give at most 4096x4096");
    for (const auto& field : header.fields) {
        const bool power = field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
        if (!power || (field.type == 'F' && field.size < 4))
            return bad(
                "has a field of an impossible SIZE: " + field.name,
                "give 1, 2, 4 or 8, for TYPE F 4 or 8"
            );
        header.point_size +=
            static_cast<std::size_t>(field.size) * static_cast<std::size_t>(field.count);
    }
    const auto points =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
    if (points * header.point_size > kMaxDataBytes) {
        return bad("has more than 512 MiB of data", "give fewer fields or a smaller cloud");
    }
    for (const char* needed : {"x", "y", "z"}) {
        const auto is_it = [&](const PcdField& f) {
            return f.name == needed && f.count == 1 && f.type == 'F';
        };
        if (std::count_if(header.fields.begin(), header.fields.end(), is_it) != 1) {
            return bad(
                std::string("has not one field ") + needed + " of TYPE F",
                "give x, y and z in metres"
            );
        }
    }
    return header;
}

/// What a line says, as far as it is text and short.
std::string shown(const Words& words) {
    std::string line;
    for (const auto& word : words)
        line += (line.empty() ? "" : " ") + word;
    const auto strange = std::find_if(line.begin(), line.end(), [](unsigned char c) {
        return c < 0x20 || c > 0x7e;
    });
    line.erase(strange, line.end());
    line.resize(std::min<std::size_t>(line.size(), 60));
    line.insert(line.begin(), '"');
    line.push_back('"');
    return line;
}

}  // namespace

Result<PcdHeader> parse_pcd_header(
    std::span<const std::uint8_t> file, const std::string& name, PcdShape shape
) {
    PcdHeader header;
    header.width = header.height = -1;  // not said yet
    const auto limit = file.first(std::min(file.size(), kMaxHeader));
    std::size_t start = 0;
    for (int number = 1; start < limit.size(); ++number) {
        const auto end =
            std::find(limit.begin() + static_cast<std::ptrdiff_t>(start), limit.end(), '\n');
        if (end == limit.end()) break;
        std::istringstream stream(
            std::string(limit.begin() + static_cast<std::ptrdiff_t>(start), end)
        );
        start = static_cast<std::size_t>(end - limit.begin()) + 1;
        Words words;
        for (std::string word; stream >> word;)
            words.push_back(word);
        if (words.empty() || words[0][0] == '#') continue;
        if (!take_line(words, header)) {
            return fail(
                ErrorCode::bad_data,
                name + ":" + std::to_string(number),
                shown(words) + " is no line of a PCD header",
                "give a PCD file of version 0.7, with as many SIZE, TYPE and COUNT as FIELDS"
            );
        }
        if (words[0] != "DATA") continue;
        header.data_offset = start;
        return check(std::move(header), name, shape);
    }
    return fail(
        ErrorCode::bad_data,
        name,
        "has no PCD header with a DATA line",
        "give a PCD file of version 0.7"
    );
}

}  // namespace kinectlab
