#include <bit>
#include <cmath>
#include <cstring>

#include "pipeline/sensor/ply_header.hpp"

namespace kinectlab {
namespace {

using namespace mesh;
using ply::Element;
using ply::Header;
using ply::Property;
using ply::Type;

constexpr std::size_t kMaxCorners = 255;

/// Reads one number after another, from words or bytes.
class Numbers {
public:
    Numbers(std::span<const std::uint8_t> data, Header::Format format)
        : data_(data), format_(format) {}

    std::optional<double> next(Type type) {
        if (format_ == Header::Format::ascii) return next_word();
        const std::size_t size = ply::size_of(type);
        if (data_.size() - at_ < size) return std::nullopt;
        std::array<std::uint8_t, 8> bytes{};
        std::memcpy(bytes.data(), data_.data() + at_, size);
        at_ += size;
        if (format_ == Header::Format::big_endian)
            std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        return number_of(bytes, type);
    }

    /// Numbers that can at most follow: a word and the space before it, or a byte, for each.
    [[nodiscard]] std::size_t most_left() const { return data_.size() - at_; }

private:
    std::optional<double> next_word() {
        const auto is_space = [](std::uint8_t c) {
            return c == ' ' || (c >= 9 && c <= 13);
        };
        while (at_ < data_.size() && is_space(data_[at_]))
            ++at_;
        const std::size_t start = at_;
        while (at_ < data_.size() && !is_space(data_[at_]))
            ++at_;
        return to_number<double>({reinterpret_cast<const char*>(data_.data()) + start, at_ - start}
        );
    }

    template <class T>
    static double as(const std::array<std::uint8_t, 8>& bytes) {
        T value{};
        std::memcpy(&value, bytes.data(), sizeof value);
        return static_cast<double>(value);
    }

    static double number_of(const std::array<std::uint8_t, 8>& bytes, Type type) {
        switch (type) {
            case Type::int8:
                return as<std::int8_t>(bytes);
            case Type::uint8:
                return as<std::uint8_t>(bytes);
            case Type::int16:
                return as<std::int16_t>(bytes);
            case Type::uint16:
                return as<std::uint16_t>(bytes);
            case Type::int32:
                return as<std::int32_t>(bytes);
            case Type::uint32:
                return as<std::uint32_t>(bytes);
            case Type::float32:
                return as<float>(bytes);
            case Type::float64:
                return as<double>(bytes);
        }
        return 0.0;
    }

    std::span<const std::uint8_t> data_;
    Header::Format format_;
    std::size_t at_ = 0;
};

/// A whole number from 0 to `most`.
std::optional<std::uint32_t> to_count(std::optional<double> value, double most) {
    if (!value || !(*value >= 0.0 && *value <= most) || *value != std::floor(*value))
        return std::nullopt;
    return static_cast<std::uint32_t>(*value);
}

bool pass_over(Numbers& numbers, const Property& property) {
    std::uint32_t count = 1;
    if (property.is_list) {
        const auto listed = to_count(numbers.next(property.count_type), 1e6);
        if (!listed) return false;
        count = *listed;
    }
    for (std::uint32_t i = 0; i < count; ++i)
        if (!numbers.next(property.type)) return false;
    return true;
}

bool take_vertex(Numbers& numbers, const Element& element, TriangleMesh& out) {
    Eigen::Vector3f vertex = Eigen::Vector3f::Zero();
    for (const auto& property : element.properties) {
        const bool is_axis = !property.is_list && property.name.size() == 1 &&
                             property.name[0] >= 'x' && property.name[0] <= 'z';
        if (!is_axis) {
            if (!pass_over(numbers, property)) return false;
            continue;
        }
        const auto value = numbers.next(property.type);
        if (!value) return false;
        vertex[property.name[0] - 'x'] = static_cast<float>(*value);
    }
    out.vertices.push_back(vertex);
    return true;
}

bool take_face(Numbers& numbers, const Element& element, TriangleMesh& out) {
    for (const auto& property : element.properties) {
        const bool is_corners = property.is_list && (property.name == "vertex_indices" ||
                                                     property.name == "vertex_index");
        if (!is_corners) {
            if (!pass_over(numbers, property)) return false;
            continue;
        }
        const auto corners = to_count(numbers.next(property.count_type), kMaxCorners);
        if (!corners) return false;
        std::array<std::uint32_t, 2> fan{};
        for (std::uint32_t k = 0; k < *corners; ++k) {
            const auto index = to_count(numbers.next(property.type), 4294967295.0);
            if (!index) return false;
            if (k == 0) fan[0] = *index;
            if (k > 1) out.triangles.push_back({fan[0], fan[1], *index});
            fan[1] = *index;
        }
    }
    return true;
}

bool has_axes(const Header& header) {
    for (const auto& element : header.elements) {
        if (element.name != "vertex") continue;
        int axes = 0;
        for (const auto& property : element.properties)
            axes += property.name == "x" || property.name == "y" || property.name == "z";
        return axes == 3;
    }
    return false;
}

}  // namespace

Result<MeshFile> parse_ply(std::span<const std::uint8_t> file, const std::string& name) {
    const auto header = ply::parse_header(file, name);
    if (!header) return tl::unexpected<Error>(header.error());
    if (!has_axes(*header))
        return fail(
            ErrorCode::bad_data,
            name,
            "has no element vertex with one x, y and z",
            "give a PLY file with a surface"
        );
    TriangleMesh out;
    Numbers numbers(file.subspan(header->data_offset), header->format);
    for (const auto& element : header->elements) {
        if (element.properties.empty()) continue;  // nothing is stored for it
        // Each entry takes a byte at least, so the count cannot ask for more than the file has.
        if (element.count > numbers.most_left() || element.count > kMaxMeshVertices)
            return fail(
                ErrorCode::bad_data,
                name,
                "says it has " + std::to_string(element.count) + " of " + shown(element.name) +
                    ", " + std::to_string(numbers.most_left()) + " bytes are left",
                "give the whole file, with at most " + std::to_string(kMaxMeshVertices)
            );
        for (std::size_t i = 0; i < element.count; ++i) {
            bool fine = true;
            if (element.name == "vertex") {
                fine = take_vertex(numbers, element, out);
            } else if (element.name == "face") {
                fine = take_face(numbers, element, out);
            } else {
                for (const auto& property : element.properties)
                    fine = fine && pass_over(numbers, property);
            }
            if (!fine || out.triangles.size() > kMaxMeshTriangles)
                return fail(
                    ErrorCode::bad_data,
                    name,
                    "is damaged or ends at " + shown(element.name) + " " + std::to_string(i) +
                        " of " + std::to_string(element.count),
                    "give the whole file; a face has up to 255 corners"
                );
        }
    }
    return tidied(std::move(out), name);
}

}  // namespace kinectlab
