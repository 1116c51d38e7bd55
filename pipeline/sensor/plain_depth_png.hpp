#pragma once

#include <cstdint>
#include <span>

namespace kinectlab {

/// Decodes the PNG that nearly all recordings hold: 16-bit grey, not interlaced, no chunks but the
/// picture's own; several times faster than libspng, which does not let its inflate be replaced.
/// False for any other file, whether unusual or damaged: libspng is then to judge it. The pixels
/// are undefined in that case.
[[nodiscard]] bool read_plain_depth_png(
    std::span<const std::uint8_t> file, std::span<std::uint16_t> depth
);

}  // namespace kinectlab
