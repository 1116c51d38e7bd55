#pragma once

#include <string>
#include <vector>

#include "pipeline/sensor/mesh_text.hpp"

namespace kinectlab::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] std::size_t size_of(Type type);

struct Property {
    std::string name;
    Type type = Type::float32;
    bool is_list = false;
    Type count_type = Type::uint8;  ///< of a list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    enum class Format { ascii, little_endian, big_endian } format = Format::ascii;
    std::vector<Element> elements;
    std::size_t lines = 0;        ///< of the header
    std::size_t data_offset = 0;  ///< of the first byte after it
};

/// At most 64 elements of 256 properties in 64 KiB.
[[nodiscard]] Result<Header> parse_header(
    std::span<const std::uint8_t> file, const std::string& name
);

}  // namespace kinectlab::ply
