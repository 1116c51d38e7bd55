#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"

namespace kinectlab {

/// Joins to a continuous piece of surface the sides of the same thing that are too steep to be
/// continuous in the picture: a box' flank of two pixels may be as deep as the box. Keeps its
/// buffers.
class SteepSides {
public:
    explicit SteepSides(const RgbdCamera& camera);

    /// The piece and what touches it in the picture, up to four pixels from it, has at least
    /// `least` votes and lies no further before or behind than half the width of a square of
    /// `area_m2`. The span is valid until the next call.
    [[nodiscard]] std::span<const std::uint32_t> join(
        std::span<const std::uint32_t> piece,
        std::span<const std::uint16_t> depth,
        std::span<const std::uint8_t> votes,
        std::uint8_t least,
        double area_m2
    );

private:
    int width_;
    double depth_unit_m_;
    std::vector<std::uint8_t> taken_;
    std::vector<std::uint32_t> pixels_;
};

}  // namespace kinectlab
