#pragma once

#include <cstdint>
#include <span>

namespace kinectlab {

/// LZF as in binary_compressed PCD files. False unless `in` gives exactly out.size() bytes; reads
/// and writes nothing outside the two spans, whatever `in` holds.
[[nodiscard]] bool decompress_lzf(std::span<const std::uint8_t> in, std::span<std::uint8_t> out);

}  // namespace kinectlab
