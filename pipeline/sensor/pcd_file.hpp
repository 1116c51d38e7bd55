#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"

namespace kinectlab {

/// An organised cloud as its file holds it: row-major, NaN where there is no reading.
struct PcdCloud {
    int width = 0;
    int height = 0;
    std::vector<float> x, y, z;     ///< m
    std::vector<std::uint8_t> rgb;  ///< 3 bytes a point; empty if the file has no colour
};

struct PcdField {
    std::string name;
    int size = 4;     ///< bytes of one element
    char type = 'F';  ///< F, I or U
    int count = 1;    ///< elements
};

struct PcdHeader {
    std::vector<PcdField> fields;
    int width = 0;
    int height = 0;
    enum class Data { ascii, binary, binary_compressed } data = Data::ascii;
    std::size_t data_offset = 0;  ///< of the first byte after the header
    std::size_t point_size = 0;   ///< bytes of all fields of one point
};

/// A frame is organised; a model may come as a mere list of points (height 1).
enum class PcdShape { organised, any };

/// A reader of our own, because PCL's trusts the sizes that a file claims and brings VTK along.
/// Refuses clouds of another shape, organised ones above 4096 x 4096, and those without x, y and z.
/// `name` stands in errors.
[[nodiscard]] Result<PcdHeader> parse_pcd_header(
    std::span<const std::uint8_t> file,
    const std::string& name,
    PcdShape shape = PcdShape::organised
);

/// Any order of fields, further fields are passed over; ascii, binary and binary_compressed.
/// Truncated data and numbers that are none are errors.
[[nodiscard]] Result<PcdCloud> parse_pcd(
    std::span<const std::uint8_t> file,
    const std::string& name,
    PcdShape shape = PcdShape::organised
);

}  // namespace kinectlab
