#include "pipeline/track/colour_bounds.hpp"

#include <algorithm>

#include "pipeline/features/hue.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kSide = 64;  // of the table, 4 values each

}  // namespace

bool passes(const ColourBounds& bounds, float r, float g, float b) {
    const Hsv hsv = hsv_of(r, g, b);
    if (hsv.saturation < bounds.saturation_min || hsv.saturation > bounds.saturation_max ||
        hsv.value < bounds.value_min || hsv.value > bounds.value_max)
        return false;
    if (bounds.hue_min_deg <= bounds.hue_max_deg)
        return hsv.hue_deg >= bounds.hue_min_deg && hsv.hue_deg <= bounds.hue_max_deg;
    return hsv.hue_deg >= bounds.hue_min_deg || hsv.hue_deg <= bounds.hue_max_deg;
}

ColourTable::ColourTable(const ColourBounds& bounds)
    : ColourTable([&](float r, float g, float b) { return kinectlab::passes(bounds, r, g, b); }) {}

ColourTable::ColourTable(const std::function<bool(float, float, float)>& passes)
    : table_(kSide * kSide * kSide) {
    const auto middle = [](std::size_t index) {
        return (static_cast<float>(index) + 0.5F) / static_cast<float>(kSide);
    };
    for (std::size_t r = 0; r < kSide; ++r)
        for (std::size_t g = 0; g < kSide; ++g)
            for (std::size_t b = 0; b < kSide; ++b)
                table_[(r * kSide + g) * kSide + b] =
                    passes(middle(r), middle(g), middle(b)) ? 1 : 0;
}

ColourTable::Entry ColourTable::entry(const ColourConstancy::Gains& gains) {
    Entry entry;
    std::uint32_t place = kSide * kSide;
    for (std::size_t c = 0; c < 3; ++c, place /= kSide)
        for (std::size_t value = 0; value < 256; ++value) {
            const float corrected = std::min(255.0F, gains[c] * static_cast<float>(value));
            entry[c][value] = static_cast<std::uint32_t>(corrected) / 4 * place;
        }
    return entry;
}

}  // namespace kinectlab
