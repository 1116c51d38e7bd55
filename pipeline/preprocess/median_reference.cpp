#include "pipeline/preprocess/median_reference.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr float kBandSigmas = 4.0F;
constexpr std::uint16_t kNoReading = 65535;  // sorted behind all readings
constexpr std::size_t kBatch = 256;          // pixels that stay in the cache while they are sorted

constexpr int kPictures = MedianReference::kPictures;
using Batch = std::array<std::array<std::uint16_t, kBatch>, kPictures>;

KINECTLAB_HOT_LOOP void load(
    const std::uint16_t* __restrict depth, std::size_t n, std::uint16_t* __restrict row
) {
    for (std::size_t i = 0; i < n; ++i)
        row[i] = static_cast<std::uint16_t>(depth[i] - 1);  // no reading: 65535, sorted last
}

/// The nearer one of each pair to `a`.
KINECTLAB_HOT_LOOP void order(std::uint16_t* __restrict a, std::uint16_t* __restrict b) {
    for (std::size_t i = 0; i < kBatch; ++i) {
        const std::uint16_t low = a[i] < b[i] ? a[i] : b[i];
        const std::uint16_t high = a[i] < b[i] ? b[i] : a[i];
        a[i] = low;
        b[i] = high;
    }
}

/// Odd-even transposition: as many rounds as pictures sort each pixel's readings.
void sort_pictures(Batch& batch, int pictures) {
    for (int round = 0; round < pictures; ++round)
        for (int k = round % 2; k + 1 < pictures; k += 2)
            order(
                batch[static_cast<std::size_t>(k)].data(),
                batch[static_cast<std::size_t>(k) + 1].data()
            );
}

struct Noise {
    float product, sigma, rounding;
};

struct Known {
    float *disparity, *variance;
    std::uint8_t* seen;
};

KINECTLAB_HOT_LOOP void pick_median(
    const Batch& batch,
    int pictures,
    std::uint16_t* __restrict median,
    std::uint16_t* __restrict valid
) {
    for (std::size_t i = 0; i < kBatch; ++i)
        valid[i] = median[i] = 0;
    for (int k = 0; k < pictures; ++k) {
        const std::uint16_t* row = batch[static_cast<std::size_t>(k)].data();
        for (std::size_t i = 0; i < kBatch; ++i)
            valid[i] = static_cast<std::uint16_t>(valid[i] + (row[i] != kNoReading ? 1 : 0));
    }
    // Of an even number the farther one: an object can only come in front of the scene.
    for (int k = 0; k < pictures; ++k) {
        const std::uint16_t* row = batch[static_cast<std::size_t>(k)].data();
        for (std::size_t i = 0; i < kBatch; ++i)
            median[i] = valid[i] / 2 == k ? row[i] : median[i];
    }
}

/// Mean and variance of the readings that agree with the median.
KINECTLAB_HOT_LOOP void average(
    const Batch& batch,
    int pictures,
    const std::uint16_t* __restrict median,
    const std::uint16_t* __restrict valid,
    const Noise& noise,
    std::size_t n,
    Known known
) {
    std::array<float, kBatch> number{}, sum{}, squares{}, centre{}, band{};
    for (std::size_t i = 0; i < kBatch; ++i) {
        const float counts = static_cast<float>(static_cast<int>(median[i])) + 1.0F;
        const float s = noise.product / counts;
        centre[i] = s;
        band[i] = kBandSigmas * (noise.sigma + noise.rounding * s * s);
    }
    for (int k = 0; k < pictures; ++k) {
        const std::uint16_t* row = batch[static_cast<std::size_t>(k)].data();
        for (std::size_t i = 0; i < kBatch; ++i) {
            const float counts = static_cast<float>(static_cast<int>(row[i])) + 1.0F;
            const float off = noise.product / counts - centre[i];
            const bool in = (off < 0.0F ? -off : off) <= band[i] && row[i] != kNoReading;
            const float kept = in ? off : 0.0F;
            number[i] += in ? 1.0F : 0.0F;
            sum[i] += kept;
            squares[i] += kept * kept;
        }
    }
    const int needed = (pictures + 1) / 2;
    for (std::size_t i = 0; i < n; ++i) {
        const bool stable = valid[i] >= needed && number[i] > 0.0F;
        const float mean = stable ? sum[i] / number[i] : 0.0F;
        known.disparity[i] = stable ? centre[i] + mean : 0.0F;
        known.variance[i] = stable ? std::max(0.0F, squares[i] / number[i] - mean * mean) : 0.0F;
        known.seen[i] = static_cast<std::uint8_t>(stable ? static_cast<int>(number[i]) : 0);
    }
}

}  // namespace

MedianReference::MedianReference(const RgbdCamera& camera, double seconds)
    : scale_(camera), span_(from_seconds(seconds)) {
    const auto pixels = static_cast<std::size_t>(camera.depth.width) *
                        static_cast<std::size_t>(camera.depth.height);
    for (auto& picture : ring_)
        picture.assign(pixels, 0);
    disparity_.assign(pixels, 0.0F);
    variance_.assign(pixels, 0.0F);
    seen_.assign(pixels, 0);
}

void MedianReference::reset() {
    pictures_ = next_ = 0;
    std::fill(disparity_.begin(), disparity_.end(), 0.0F);
    std::fill(variance_.begin(), variance_.end(), 0.0F);
    std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
}

bool MedianReference::add(std::span<const std::uint16_t> depth, TimeNs t) {
    const auto slot = [](int k) {
        return static_cast<std::size_t>((k % kPictures + kPictures) % kPictures);
    };
    if (pictures_ == 0) first_ = t;
    if (pictures_ > 0 && t - taken_[slot(next_ - 1)] < span_ / kPictures) return false;
    std::copy(depth.begin(), depth.end(), ring_[slot(next_)].begin());
    taken_[slot(next_)] = t;
    next_ = static_cast<int>(slot(next_ + 1));
    pictures_ = std::min(kPictures, pictures_ + 1);
    while (pictures_ > kLeastPictures && t - taken_[slot(next_ - pictures_)] > span_)
        --pictures_;
    return true;
}

void MedianReference::update() {
    Batch batch{};
    std::array<std::uint16_t, kBatch> median{}, valid{};
    const Noise noise{
        static_cast<float>(scale_.product),
        static_cast<float>(scale_.sigma_steps),
        static_cast<float>(scale_.rounding_steps(1.0))};
    for (std::size_t first = 0; first < disparity_.size(); first += kBatch) {
        const std::size_t n = std::min(kBatch, disparity_.size() - first);
        for (int k = 0; k < pictures_; ++k) {
            const auto from =
                static_cast<std::size_t>((next_ - pictures_ + k + kPictures) % kPictures);
            load(ring_[from].data() + first, n, batch[static_cast<std::size_t>(k)].data());
        }
        sort_pictures(batch, pictures_);
        pick_median(batch, pictures_, median.data(), valid.data());
        average(
            batch,
            pictures_,
            median.data(),
            valid.data(),
            noise,
            n,
            {disparity_.data() + first, variance_.data() + first, seen_.data() + first}
        );
    }
}

}  // namespace kinectlab
