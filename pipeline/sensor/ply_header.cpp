#include "pipeline/sensor/ply_header.hpp"

#include <algorithm>

namespace kinectlab::ply {
namespace {

using namespace mesh;

constexpr std::size_t kMaxHeader = 64 * 1024;
constexpr std::size_t kMaxElements = 64;
constexpr std::size_t kMaxProperties = 256;

std::optional<Type> to_type(std::string_view word) {
    struct Name {
        std::string_view old_name, name;
        Type type;
    };
    static constexpr std::array<Name, 8> kNames{{
        {"char", "int8", Type::int8},
        {"uchar", "uint8", Type::uint8},
        {"short", "int16", Type::int16},
        {"ushort", "uint16", Type::uint16},
        {"int", "int32", Type::int32},
        {"uint", "uint32", Type::uint32},
        {"float", "float32", Type::float32},
        {"double", "float64", Type::float64},
    }};
    for (const auto& known : kNames)
        if (word == known.old_name || word == known.name) return known.type;
    return std::nullopt;
}

bool take_format(std::string_view line, Header& header) {
    const auto word = take_word(line);
    if (word == "ascii") header.format = Header::Format::ascii;
    if (word == "binary_little_endian") header.format = Header::Format::little_endian;
    if (word == "binary_big_endian") header.format = Header::Format::big_endian;
    return word == "ascii" || word == "binary_little_endian" || word == "binary_big_endian";
}

bool take_element(std::string_view line, Header& header) {
    Element element;
    element.name = take_word(line);
    const auto count = to_number<std::uint64_t>(take_word(line));
    if (element.name.empty() || !count || header.elements.size() == kMaxElements) return false;
    element.count = static_cast<std::size_t>(*count);
    header.elements.push_back(std::move(element));
    return true;
}

bool take_property(std::string_view line, Header& header) {
    if (header.elements.empty()) return false;
    auto& properties = header.elements.back().properties;
    Property property;
    auto word = take_word(line);
    if (word == "list") {
        property.is_list = true;
        const auto count_type = to_type(take_word(line));
        if (!count_type || *count_type == Type::float32 || *count_type == Type::float64)
            return false;
        property.count_type = *count_type;
        word = take_word(line);
    }
    const auto type = to_type(word);
    property.name = take_word(line);
    if (!type || property.name.empty() || properties.size() == kMaxProperties) return false;
    property.type = *type;
    properties.push_back(std::move(property));
    return true;
}

bool take_line(std::string_view line, Header& header) {
    const auto key = take_word(line);
    if (key == "format") return take_format(line, header);
    if (key == "element") return take_element(line, header);
    if (key == "property") return take_property(line, header);
    return key.empty() || key == "comment" || key == "obj_info";
}

}  // namespace

std::size_t size_of(Type type) {
    static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

Result<Header> parse_header(std::span<const std::uint8_t> file, const std::string& name) {
    Header header;
    bool has_format = false;
    Text text(file.first(std::min(file.size(), kMaxHeader)));
    std::string_view line;
    if (!text.next_line(line) || line != "ply")
        return fail(ErrorCode::bad_data, name, "does not begin with \"ply\"", "give a PLY file");
    while (text.next_line(line)) {
        if (line == "end_header") {
            if (!has_format) break;
            header.lines = text.line_number();
            header.data_offset = text.position();
            return header;
        }
        has_format = has_format || line.starts_with("format");
        if (!take_line(line, header))
            return bad_line(
                name,
                text.line_number(),
                "is no line of a PLY header: " + shown(line),
                "give format, element, property, comment or end_header"
            );
    }
    return fail(
        ErrorCode::bad_data, name, "has no whole PLY header with a format", "give a PLY file of 1.0"
    );
}

}  // namespace kinectlab::ply
