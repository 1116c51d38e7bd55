#include "pipeline/sensor/pcd_file.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "pipeline/sensor/lzf.hpp"

namespace kinectlab {
namespace {

// Where a field's first element lies: byte `offset + point * stride`.
struct Column {
    PcdField field;
    std::size_t offset = 0;
    std::size_t stride = 0;
};

std::vector<Column> columns_of(const PcdHeader& header, std::size_t points) {
    // Compressed data holds each field for all points in turn, plain data each point with all
    // fields.
    const bool by_field = header.data == PcdHeader::Data::binary_compressed;
    std::vector<Column> columns;
    std::size_t offset = 0;
    for (const auto& field : header.fields) {
        const auto size =
            static_cast<std::size_t>(field.size) * static_cast<std::size_t>(field.count);
        columns.push_back({field, offset, by_field ? size : header.point_size});
        offset += by_field ? size * points : size;
    }
    return columns;
}

const Column* find(const std::vector<Column>& columns, const std::string& name) {
    for (const auto& column : columns) {
        if (column.field.name == name) return &column;
    }
    return nullptr;
}

void read_floats(
    std::span<const std::uint8_t> data, const Column& column, std::vector<float>& out
) {
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::uint8_t* at = data.data() + column.offset + i * column.stride;
        if (column.field.size == 4) {
            std::memcpy(&out[i], at, 4);
        } else {
            double wide = 0;
            std::memcpy(&wide, at, 8);
            out[i] = static_cast<float>(wide);
        }
    }
}

// A colour is four bytes b, g, r, a, whatever type the header gives them.
void read_colours(
    std::span<const std::uint8_t> data, const Column& column, std::vector<std::uint8_t>& rgb
) {
    for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
        const std::uint8_t* at = data.data() + column.offset + i * column.stride;
        for (std::size_t c = 0; c < 3; ++c)
            rgb[3 * i + c] = at[2 - c];
    }
}

PcdCloud cloud_of(const PcdHeader& header, std::span<const std::uint8_t> data) {
    const auto points =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
    const auto columns = columns_of(header, points);
    PcdCloud cloud{
        header.width,
        header.height,
        std::vector<float>(points),
        std::vector<float>(points),
        std::vector<float>(points),
        {}};
    read_floats(data, *find(columns, "x"), cloud.x);
    read_floats(data, *find(columns, "y"), cloud.y);
    read_floats(data, *find(columns, "z"), cloud.z);
    const Column* colour = find(columns, "rgb");
    if (colour == nullptr) colour = find(columns, "rgba");
    if (colour != nullptr && colour->field.size == 4) {
        cloud.rgb.resize(3 * points);
        read_colours(data, *colour, cloud.rgb);
    }
    return cloud;
}

std::uint32_t read_u32(const std::uint8_t* at) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, 4);
    return value;
}

template <class T>
void put(std::vector<std::uint8_t>& out, double value, int size) {
    const T narrow = static_cast<T>(value);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&narrow);
    out.insert(out.end(), bytes, bytes + size);
}

// One number of an ascii file as the bytes it would have in a binary one.
bool append_word(std::vector<std::uint8_t>& out, const PcdField& field, const std::string& word) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end == word.c_str() || *end != '\0') return false;
    if (field.type == 'F') {
        field.size == 4 ? put<float>(out, value, 4) : put<double>(out, value, 8);
        return true;
    }
    if (!(std::abs(value) < 9e18)) return false;
    put<std::int64_t>(out, value, field.size);  // little-endian: the low bytes come first
    return true;
}

Result<std::vector<std::uint8_t>> bytes_of_ascii(
    const PcdHeader& header,
    std::span<const std::uint8_t> text,
    std::size_t points,
    const std::string& name
) {
    std::vector<std::uint8_t> out;
    out.reserve(points * header.point_size);
    std::size_t at = 0;
    const auto is_space = [](std::uint8_t c) {
        return c == ' ' || c == '\n' || c == '\r' || c == '\t';
    };
    const auto next_word = [&] {
        while (at < text.size() && is_space(text[at]))
            ++at;
        const std::size_t start = at;
        while (at < text.size() && !is_space(text[at]) && at - start < 64)
            ++at;
        return std::string(
            text.begin() + static_cast<std::ptrdiff_t>(start),
            text.begin() + static_cast<std::ptrdiff_t>(at)
        );
    };
    for (std::size_t i = 0; i < points; ++i) {
        for (const auto& field : header.fields) {
            for (int c = 0; c < field.count; ++c) {
                const std::string word = next_word();
                if (append_word(out, field, word)) continue;
                return fail(
                    ErrorCode::bad_data,
                    name,
                    "holds \"" + word + "\" in point " + std::to_string(i) + " of " +
                        std::to_string(points),
                    "give a number for every field of every point"
                );
            }
        }
    }
    return out;
}

}  // namespace

Result<PcdCloud> parse_pcd(
    std::span<const std::uint8_t> file, const std::string& name, PcdShape shape
) {
    const auto header = parse_pcd_header(file, name, shape);
    if (!header) return tl::unexpected<Error>(header.error());
    const auto truncated = [&] {
        return fail(
            ErrorCode::bad_data,
            name,
            "is shorter than its header says, or damaged",
            "give the whole file"
        );
    };
    const auto points =
        static_cast<std::size_t>(header->width) * static_cast<std::size_t>(header->height);
    const std::size_t size = points * header->point_size;
    const auto data = file.subspan(header->data_offset);

    if (header->data == PcdHeader::Data::binary) {
        if (data.size() < size) return truncated();
        return cloud_of(*header, data.first(size));
    }
    if (header->data == PcdHeader::Data::ascii) {
        // Every number takes at least a digit and a space: memory is only taken for what can be
        // there.
        if (data.size() < points * 2) return truncated();
        const auto bytes = bytes_of_ascii(*header, data, points, name);
        if (!bytes) return tl::unexpected<Error>(bytes.error());
        return cloud_of(*header, *bytes);
    }
    // LZF makes at most 264 bytes of 3, so a small file cannot ask for much memory.
    if (data.size() < 8) return truncated();
    const std::size_t packed = read_u32(data.data());
    if (read_u32(data.data() + 4) != size || packed > data.size() - 8 || size / 88 > packed)
        return truncated();
    std::vector<std::uint8_t> bytes(size);
    if (!decompress_lzf(data.subspan(8, packed), bytes)) return truncated();
    return cloud_of(*header, bytes);
}

}  // namespace kinectlab
