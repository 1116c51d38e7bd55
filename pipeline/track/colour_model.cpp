#include "pipeline/track/colour_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinectlab {
namespace {

constexpr int kHues = 36, kSaturations = 8, kValues = 10;
constexpr std::size_t kCells = static_cast<std::size_t>(kHues * kSaturations * kValues);
constexpr int kGreySaturations = 1;  // the lowest cells: noise decides their hue
constexpr double kMoreOften = 2.0;   // inside than outside
constexpr double kRarest = 0.02;     // of the commonest cell's share: rarer ones are noise
constexpr double kFewestShare = 0.05;

using Cells = std::array<double, kCells>;

std::size_t cell(int hue, int saturation, int value) {
    return static_cast<std::size_t>((hue * kSaturations + saturation) * kValues + value);
}

struct Place {
    int hue, saturation, value;
};

Place place_of(const Hsv& hsv) {
    const auto part = [](float share, int parts) {
        return std::min(parts - 1, static_cast<int>(share * static_cast<float>(parts)));
    };
    return {
        static_cast<int>(hsv.hue_deg / (360.0F / kHues)) % kHues,
        part(hsv.saturation, kSaturations),
        part(hsv.value, kValues)};
}

/// Shares of the pixels, each spread over the cells around its own; greys over all hues.
Cells shares(std::span<const Hsv> pixels) {
    Cells counts{}, spread{};
    for (const Hsv& hsv : pixels) {
        const Place at = place_of(hsv);
        counts[cell(at.hue, at.saturation, at.value)] += 1.0;
    }
    for (int s = 0; s < kGreySaturations; ++s)
        for (int v = 0; v < kValues; ++v) {
            double all = 0.0;
            for (int h = 0; h < kHues; ++h)
                all += counts[cell(h, s, v)];
            for (int h = 0; h < kHues; ++h)
                counts[cell(h, s, v)] = all / kHues;
        }
    const double each = 1.0 / std::max<double>(1.0, static_cast<double>(pixels.size()));
    for (int h = 0; h < kHues; ++h)
        for (int s = 0; s < kSaturations; ++s)
            for (int v = 0; v < kValues; ++v)
                for (int dh = -1; dh <= 1; ++dh)
                    for (int ds = -1; ds <= 1; ++ds)
                        for (int dv = -1; dv <= 1; ++dv) {
                            const int t = std::clamp(s + ds, 0, kSaturations - 1);
                            const int w = std::clamp(v + dv, 0, kValues - 1);
                            const double weight =
                                (2 - std::abs(dh)) * (2 - std::abs(ds)) * (2 - std::abs(dv)) / 64.0;
                            spread[cell(h, s, v)] +=
                                each * weight * counts[cell((h + dh + kHues) % kHues, t, w)];
                        }
    return spread;
}

double share_that_passes(std::span<const Hsv> pixels, const std::array<bool, kCells>& passes) {
    std::size_t count = 0;
    for (const Hsv& hsv : pixels) {
        const Place at = place_of(hsv);
        count += passes[cell(at.hue, at.saturation, at.value)] ? 1 : 0;
    }
    return static_cast<double>(count) / std::max<double>(1.0, static_cast<double>(pixels.size()));
}

}  // namespace

std::optional<ColourModel> learn_colours(
    std::span<const Hsv> inside, std::span<const Hsv> outside
) {
    const Cells in = shares(inside), out = shares(outside);
    const double rarest = kRarest * *std::max_element(in.begin(), in.end());
    std::array<bool, kCells> passes{};
    for (std::size_t i = 0; i < kCells; ++i)
        passes[i] = in[i] > rarest && in[i] > kMoreOften * out[i];
    const double share_inside = share_that_passes(inside, passes);
    const double share_outside = share_that_passes(outside, passes);
    if (inside.empty() || share_inside < kFewestShare) return std::nullopt;
    return ColourModel{
        ColourTable([&](float r, float g, float b) {
            const Place at = place_of(hsv_of(r, g, b));
            return passes[cell(at.hue, at.saturation, at.value)];
        }),
        share_inside,
        share_outside};
}

}  // namespace kinectlab
