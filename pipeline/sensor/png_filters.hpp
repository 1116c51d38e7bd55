#pragma once

#include <cstdint>
#include <span>

namespace kinectlab {

/// Gives the counts of one row of a 16-bit grey PNG back from its filtered bytes, two for each of
/// `out`. `above` is the row before it, as long, of zeros for the first. False if the standard has
/// no such filter.
[[nodiscard]] bool undo_png_filter(
    int filter,
    const std::uint8_t* filtered,
    const std::uint16_t* above,
    std::span<std::uint16_t> out
);

}  // namespace kinectlab
