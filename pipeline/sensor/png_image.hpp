#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"

namespace kinectlab {

/// Pictures above this side length are refused before any memory is taken for them.
constexpr int kMaxPictureSide = 4096;

enum class PngKind { depth16, rgb8 };

struct PngSize {
    int width = 0;
    int height = 0;
    friend bool operator==(const PngSize&, const PngSize&) = default;
};

/// Checks the header: 16-bit grey (depth16) or 8-bit RGB or RGBA (rgb8), at most 4096 x 4096.
/// `name` stands in errors.
[[nodiscard]] Result<PngSize> read_png_size(
    std::span<const std::uint8_t> file, PngKind kind, const std::string& name
);

/// Decodes row-major into a buffer that must have the size read_png_size gives. Damaged or
/// truncated files are errors.
[[nodiscard]] Result<void> decode_png(
    std::span<const std::uint8_t> file, std::span<std::uint16_t> depth, const std::string& name
);
[[nodiscard]] Result<void> decode_png(
    std::span<const std::uint8_t> file, std::span<std::uint8_t> rgb, const std::string& name
);

/// Whether a file is whole, without decoding it: its chunks follow each other to the end, and their
/// checksums are right.
[[nodiscard]] Result<void> check_png(std::span<const std::uint8_t> file, const std::string& name);

/// The file's bytes; fast rather than small. Throws if the encoder fails.
[[nodiscard]] std::vector<std::uint8_t> encode_png(
    std::span<const std::uint16_t> depth, PngSize size
);
[[nodiscard]] std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgb, PngSize size);

}  // namespace kinectlab
