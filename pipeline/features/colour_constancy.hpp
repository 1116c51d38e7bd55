#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kinectlab {

/// Takes a camera's own adjustments of brightness and white balance out of its pictures: one gain
/// for each channel (von Kries), the median ratio between a reference picture and now over a grid
/// of pixels. The median does not care for what moved, as long as half of the picture did not.
/// Gains of the coded values are right too: coding by a power turns a gain into a gain.
class ColourConstancy {
public:
    using Gains = std::array<float, 3>;

    /// Keeps a grid of this picture (3 bytes a pixel) as the reference.
    void learn(std::span<const std::uint8_t> rgb, int width);

    /// Multiply red, green and blue by these and the picture looks as the reference did; 1 where
    /// too few pixels are neither black nor saturated. The size must be the reference's.
    [[nodiscard]] Gains gains(std::span<const std::uint8_t> rgb) const;

    [[nodiscard]] bool has_reference() const { return !reference_.empty(); }
    void reset() { reference_.clear(); }

private:
    struct GridPixel {
        std::uint32_t at = 0;  ///< of its first byte
        std::array<std::uint8_t, 3> rgb{};
    };
    std::vector<GridPixel> reference_;
};

}  // namespace kinectlab
