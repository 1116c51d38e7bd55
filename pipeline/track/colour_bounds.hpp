#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "pipeline/features/colour_constancy.hpp"
#include "pipeline/track/object_spec.hpp"

namespace kinectlab {

/// Whether a colour lies within bounds; hue wraps around at red.
[[nodiscard]] bool passes(const ColourBounds& bounds, float r, float g, float b);

/// Which colours pass as a table over 64x64x64 colours: one look-up a pixel.
class ColourTable {
public:
    explicit ColourTable(const ColourBounds& bounds);
    /// `passes` is asked with red, green and blue, each 0 to 1.
    explicit ColourTable(const std::function<bool(float, float, float)>& passes);

    /// How to enter the table for pictures that need these gains: the sum of three entries.
    using Entry = std::array<std::array<std::uint32_t, 256>, 3>;
    [[nodiscard]] static Entry entry(const ColourConstancy::Gains& gains);

    [[nodiscard]] bool passes(const Entry& entry, const std::uint8_t* rgb) const {
        return table_[entry[0][rgb[0]] + entry[1][rgb[1]] + entry[2][rgb[2]]] != 0;
    }

private:
    std::vector<std::uint8_t> table_;
};

}  // namespace kinectlab
