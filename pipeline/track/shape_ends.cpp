#include "pipeline/track/shape_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinectlab {
namespace {

constexpr std::size_t kBins = 96;
constexpr std::size_t kLongestGap = kBins / 8;

struct Bins {
    float least = 1e9F, most = -1e9F, per_m = 0.0F;
    std::array<int, kBins> met{}, on{};  // rays that meet the shape there, and those that read it
};

Bins fill(const ShapePixels& pixels, float gate) {
    Bins bins;
    for (std::size_t i = 0; i < pixels.offered; ++i) {
        if (pixels.weight[i] <= 0.0F) continue;
        bins.least = std::min(bins.least, pixels.height[i]);
        bins.most = std::max(bins.most, pixels.height[i]);
    }
    if (!(bins.most > bins.least)) return bins;
    bins.per_m = static_cast<float>(kBins) / (bins.most - bins.least);
    for (std::size_t i = 0; i < pixels.offered; ++i) {
        const float height = pixels.height[i];
        if (pixels.used[i] == 0.0F || height < bins.least || height > bins.most) continue;
        const auto bin =
            std::min(kBins - 1, static_cast<std::size_t>((height - bins.least) * bins.per_m));
        ++bins.met[bin];
        if (std::abs(pixels.residual[i]) < gate) ++bins.on[bin];
    }
    return bins;
}

struct Run {
    std::size_t from = 0, to = 0;
};

/// The longest run of bins that show the shape; short gaps are bridged.
Run longest_run(const Bins& bins) {
    auto sorted = bins.on;
    std::nth_element(sorted.begin(), sorted.begin() + kBins / 2, sorted.end());
    const int few = sorted[kBins / 2] / 4;
    Run best;
    std::size_t from = 0, gap = 0, last_good = 0;
    bool inside = false;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        if (bins.on[bin] > few && 10 * bins.on[bin] >= 7 * bins.met[bin]) {
            if (!inside) from = bin;
            inside = true;
            last_good = bin;
            gap = 0;
        } else if (inside && ++gap > kLongestGap) {
            inside = false;
        }
        if (inside && last_good + 1 - from > best.to - best.from) best = {from, last_good + 1};
    }
    return best;
}

}  // namespace

std::optional<ShapeEnds> seen_ends(const ShapePixels& pixels, double gate_steps, double margin_m) {
    const Bins bins = fill(pixels, static_cast<float>(gate_steps));
    if (!(bins.most > bins.least)) return std::nullopt;
    const Run run = longest_run(bins);
    if (run.to == run.from) return std::nullopt;
    const ShapeEnds ends{
        bins.least + static_cast<double>(run.from) / bins.per_m + margin_m,
        bins.least + static_cast<double>(run.to) / bins.per_m - margin_m};
    if (ends.high - ends.low < 2.0 * margin_m) return std::nullopt;
    return ends;
}

}  // namespace kinectlab
