#include "pipeline/features/colour_constancy.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr int kGrid = 8;                                 // px
constexpr std::uint8_t kDarkest = 16, kBrightest = 240;  // what lies beyond is cut off
constexpr std::size_t kBins = 256;
constexpr float kBinsPerOctave = 64.0F;
constexpr int kFewest = 100;

std::size_t bin_of(float ratio) {
    const float bin = kBinsPerOctave * std::log2(ratio) + static_cast<float>(kBins / 2);
    return static_cast<std::size_t>(std::clamp(bin, 0.0F, static_cast<float>(kBins - 1)));
}

/// The ratio below which half of the counts lie, evenly spread within its bin.
float median_of(const std::array<int, kBins>& counts, int total) {
    int below = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        if (2 * (below + counts[bin]) < total) {
            below += counts[bin];
            continue;
        }
        const float into = (0.5F * static_cast<float>(total - 2 * below)) /
                           static_cast<float>(std::max(1, counts[bin]));
        const float octaves =
            (static_cast<float>(bin) + into - static_cast<float>(kBins / 2)) / kBinsPerOctave;
        return std::exp2(octaves);
    }
    return 1.0F;
}

}  // namespace

void ColourConstancy::learn(std::span<const std::uint8_t> rgb, int width) {
    reference_.clear();
    const auto pixels = rgb.size() / 3;
    const auto columns = static_cast<std::size_t>(width);
    for (std::size_t i = 0; i < pixels; ++i) {
        if (i % columns % kGrid != 0 || i / columns % kGrid != 0) continue;
        GridPixel pixel{static_cast<std::uint32_t>(3 * i), {}};
        std::copy_n(rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, pixel.rgb.begin());
        reference_.push_back(pixel);
    }
}

ColourConstancy::Gains ColourConstancy::gains(std::span<const std::uint8_t> rgb) const {
    Gains gains{1.0F, 1.0F, 1.0F};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        std::array<int, kBins> counts{};
        int total = 0;
        for (const auto& pixel : reference_) {
            const std::uint8_t then = pixel.rgb[channel], now = rgb[pixel.at + channel];
            if (std::min(then, now) < kDarkest || std::max(then, now) > kBrightest) continue;
            ++counts[bin_of(static_cast<float>(then) / static_cast<float>(now))];
            ++total;
        }
        if (total >= kFewest) gains[channel] = median_of(counts, total);
    }
    return gains;
}

}  // namespace kinectlab
