#include "pipeline/track/colour_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/features/hue.hpp"

namespace kinectlab {
namespace {

constexpr int kHueBins = 72;
constexpr double kBin_deg = 360.0 / kHueBins;
constexpr float kLeastSaturation = 0.15F;  // below it noise decides the hue
constexpr float kLeastValue = 0.10F;
constexpr int kClick_px = 8, kAroundClick_px = 3;
constexpr double kFoot = 0.12;  // of the peak, where its hues end
constexpr double kHueMargin_deg = 4.0;
constexpr double kOutliers = 0.03;  // of the pixels may be greyer or darker than the rest
constexpr double kSaturationMargin = 0.75, kValueMargin = 0.5;
constexpr double kFewestShare = 0.2;  // of the box's inner half must have a hue at all
constexpr std::size_t kSide = 64;     // of the table, 4 values each

using Histogram = std::array<double, kHueBins>;

struct Area {
    int left, top, right, bottom;
};

Area inner_half(const PictureBox& box, int width, int height) {
    if (box.width <= kClick_px && box.height <= kClick_px)
        return {
            std::max(0, box.left - kAroundClick_px),
            std::max(0, box.top - kAroundClick_px),
            std::min(width, box.left + box.width + kAroundClick_px),
            std::min(height, box.top + box.height + kAroundClick_px)};
    const int x = box.width / 7, y = box.height / 7;  // (5/7)² is half of the area
    return {box.left + x, box.top + y, box.left + box.width - x, box.top + box.height - y};
}

class HuePicture {
public:
    HuePicture(std::span<const std::uint8_t> rgb, int width, const ColourConstancy::Gains& gains)
        : rgb_(rgb), width_(width), gains_(gains) {}

    [[nodiscard]] Hsv at(int u, int v) const {
        const auto* p = rgb_.data() + 3 * static_cast<std::ptrdiff_t>(v * width_ + u);
        const auto part = [&](std::size_t c) {
            return std::min(1.0F, gains_[c] * static_cast<float>(p[c]) / 255.0F);
        };
        return hsv_of(part(0), part(1), part(2));
    }

private:
    std::span<const std::uint8_t> rgb_;
    int width_;
    ColourConstancy::Gains gains_;
};

bool has_hue(const Hsv& hsv) {
    return hsv.saturation >= kLeastSaturation && hsv.value >= kLeastValue;
}

int bin_of(const Hsv& hsv) {
    return static_cast<int>(hsv.hue_deg / kBin_deg) % kHueBins;
}

double quantile(std::vector<float>& values, double share) {
    const auto nth = values.begin() +
                     static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

/// Triangle of five bins, around the circle.
Histogram smoothed(const Histogram& histogram) {
    Histogram smooth{};
    for (int bin = 0; bin < kHueBins; ++bin)
        for (int off = -2; off <= 2; ++off)
            smooth[static_cast<std::size_t>(bin)] +=
                (3 - std::abs(off)) / 9.0 *
                histogram[static_cast<std::size_t>((bin + off + kHueBins) % kHueBins)];
    return smooth;
}

/// Mean weight a pixel for each hue over an area, less another area inside of it.
Histogram hues(const HuePicture& picture, const Area& area, const Area* without) {
    Histogram histogram{};
    int pixels = 0;
    for (int v = area.top; v < area.bottom; ++v)
        for (int u = area.left; u < area.right; ++u) {
            if (without != nullptr && u >= without->left && u < without->right &&
                v >= without->top && v < without->bottom)
                continue;
            ++pixels;
            const Hsv hsv = picture.at(u, v);
            if (has_hue(hsv)) histogram[static_cast<std::size_t>(bin_of(hsv))] += hsv.saturation;
        }
    for (auto& value : histogram)
        value /= std::max(1, pixels);
    return smoothed(histogram);
}

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

std::optional<ColourBounds> learn_bounds(
    std::span<const std::uint8_t> rgb,
    int width,
    int height,
    const PictureBox& box,
    const ColourConstancy::Gains& gains
) {
    const HuePicture picture(rgb, width, gains);
    const Area inner = inner_half(box, width, height);
    Histogram histogram = hues(picture, inner, nullptr);
    if (box.width > kClick_px || box.height > kClick_px) {
        const Area whole{box.left, box.top, box.left + box.width, box.top + box.height};
        const Area around{
            std::max(0, whole.left - box.width / 4),
            std::max(0, whole.top - box.height / 4),
            std::min(width, whole.right + box.width / 4),
            std::min(height, whole.bottom + box.height / 4)};
        const Histogram outside = hues(picture, around, &whole);
        for (std::size_t bin = 0; bin < kHueBins; ++bin)
            histogram[bin] = std::max(0.0, histogram[bin] - outside[bin]);
    }

    // The peak and its foot to both sides.
    const auto peak =
        static_cast<int>(std::max_element(histogram.begin(), histogram.end()) - histogram.begin());
    const double foot = kFoot * histogram[static_cast<std::size_t>(peak)];
    if (foot <= 0.0) return std::nullopt;
    const auto reach = [&](int direction) {
        int bins = 0;
        while (bins < kHueBins / 4 && histogram[static_cast<std::size_t>(
                                          (peak + direction * (bins + 1) + kHueBins) % kHueBins
                                      )] > foot)
            ++bins;
        return bins;
    };
    const int below = reach(-1), above = reach(1);
    ColourBounds bounds;
    const double low = (peak - below) * kBin_deg - kHueMargin_deg;
    const double high = (peak + above + 1) * kBin_deg + kHueMargin_deg;
    bounds.hue_min_deg = std::fmod(low + 360.0, 360.0);
    bounds.hue_max_deg = std::fmod(high, 360.0);

    std::vector<float> saturations, values;
    for (int v = inner.top; v < inner.bottom; ++v)
        for (int u = inner.left; u < inner.right; ++u) {
            const Hsv hsv = picture.at(u, v);
            const int off =
                (bin_of(hsv) - peak + kHueBins + kHueBins / 2) % kHueBins - kHueBins / 2;
            if (!has_hue(hsv) || off < -below || off > above) continue;
            saturations.push_back(hsv.saturation);
            values.push_back(hsv.value);
        }
    const double area = static_cast<double>(inner.right - inner.left) * (inner.bottom - inner.top);
    if (static_cast<double>(values.size()) < kFewestShare * area) return std::nullopt;
    bounds.saturation_min =
        std::max<double>(kLeastSaturation, kSaturationMargin * quantile(saturations, kOutliers));
    bounds.value_min = std::max<double>(kLeastValue, kValueMargin * quantile(values, kOutliers));
    return bounds;
}

ColourTable::ColourTable(const ColourBounds& bounds) : table_(kSide * kSide * kSide) {
    const auto middle = [](std::size_t index) {
        return (static_cast<float>(index) + 0.5F) / static_cast<float>(kSide);
    };
    for (std::size_t r = 0; r < kSide; ++r)
        for (std::size_t g = 0; g < kSide; ++g)
            for (std::size_t b = 0; b < kSide; ++b)
                table_[(r * kSide + g) * kSide + b] =
                    kinectlab::passes(bounds, middle(r), middle(g), middle(b)) ? 1 : 0;
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
