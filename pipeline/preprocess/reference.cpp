#include "pipeline/preprocess/reference.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/marks.hpp"

namespace kinectlab {
namespace {

constexpr float kBandSigmas = 4.0F;        // readings this near belong to the same surface
constexpr float kNearSpreadSteps = 8.0F;   // nearer by more is an object, not noise
constexpr float kDriftWeight = 1.0F / 32;  // of a new reading once objects move
constexpr float kNoReading = 1e6F;         // steps: "farther" than anything
constexpr int kInvalidVisits = 12;         // six seconds without a reading: forgotten

struct Strip {
    const std::uint16_t* depth;
    float* disparity;
    std::uint8_t* unusual;
    std::size_t size;
};

/// Moves the reference by drift where the reading agrees with it, and marks the other pixels that
/// may need more thought: no reading, no reference, or farther than the reference.
KINECTLAB_HOT_LOOP void follow_drift(Strip strip, float product, float sigma, float rounding) {
    const std::uint16_t* __restrict depth = strip.depth;
    float* __restrict disparity = strip.disparity;
    std::uint8_t* __restrict unusual = strip.unusual;
    for (std::size_t i = 0; i < strip.size; ++i) {
        const auto counts = static_cast<float>(depth[i]);
        const float s = counts > 0.0F ? product / counts : -kNoReading;
        const float reference = disparity[i];
        const float deviation = s - reference;
        const float band = kBandSigmas * (sigma + rounding * reference * reference);
        const float drift = std::abs(deviation) <= band ? kDriftWeight * deviation : 0.0F;
        disparity[i] = reference + drift;
        // Nearer than a reference: an object, nothing to learn from.
        const float farther = deviation < -band ? 1.0F : 0.0F;
        unusual[i] = static_cast<std::uint8_t>(static_cast<int>(reference > 0.0F ? farther : 1.0F));
    }
}

/// Marks the readings that are farther than the reference by more than the spread.
KINECTLAB_HOT_LOOP void mark_uncovered(
    const std::uint16_t* __restrict depth,
    const float* __restrict disparity,
    std::uint8_t* __restrict unusual,
    std::size_t size,
    float product
) {
    for (std::size_t i = 0; i < size; ++i) {
        const auto counts = static_cast<float>(depth[i]);
        // Without a reading this is infinitely near, and so not marked.
        const float farther = product / counts < disparity[i] - kNearSpreadSteps ? 1.0F : 0.0F;
        unusual[i] = static_cast<std::uint8_t>(static_cast<int>(farther));
    }
}

}  // namespace

ReferenceScene::ReferenceScene(const RgbdCamera& camera)
    : width_(camera.depth.width),
      height_(camera.depth.height),
      scale_(camera),
      sigma_(static_cast<float>(scale_.sigma_steps)),
      rounding_(static_cast<float>(scale_.rounding_steps(1.0))) {
    const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    for (auto* field : {&disparity_, &variance_, &candidate_})
        field->assign(pixels, 0.0F);
    for (auto* field : {&seen_, &hits_, &invalid_})
        field->assign(pixels, 0);
    const auto strip_rows = static_cast<std::size_t>((height_ + kStrips - 1) / kStrips);
    unusual_.assign(strip_rows * static_cast<std::size_t>(width_), 0);
}

void ReferenceScene::reset() {
    for (auto* field : {&disparity_, &variance_, &candidate_})
        std::fill(field->begin(), field->end(), 0.0F);
    for (auto* field : {&seen_, &hits_, &invalid_})
        std::fill(field->begin(), field->end(), 0);
    learned_frames_ = 0;
    next_strip_ = 0;
}

void ReferenceScene::assign(const SceneView& scene) {
    reset();
    std::copy(scene.disparity.begin(), scene.disparity.end(), disparity_.begin());
    std::copy(scene.variance.begin(), scene.variance.end(), variance_.begin());
    std::copy(scene.seen.begin(), scene.seen.end(), seen_.begin());
    learned_frames_ = 1;
}

float ReferenceScene::band(float s) const {
    return kBandSigmas * (sigma_ + rounding_ * s * s);
}

void ReferenceScene::learn(std::span<const std::uint16_t> depth) {
    const auto product = static_cast<float>(scale_.product);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (depth[i] == 0) continue;
        learn_pixel(i, product / static_cast<float>(depth[i]));
    }
    ++learned_frames_;
}

void ReferenceScene::learn_pixel(std::size_t i, float s) {
    invalid_[i] = 0;
    if (seen_[i] == 0) return adopt(i, s, 1);
    const float deviation = s - disparity_[i];
    const float tolerance = band(disparity_[i]);
    if (std::abs(deviation) <= tolerance) {
        seen_[i] = static_cast<std::uint8_t>(std::min(kMaxSeen, seen_[i] + 1));
        disparity_[i] += deviation / static_cast<float>(seen_[i]);
    }
    if (std::abs(deviation) <= kNearSpreadSteps)
        variance_[i] += (deviation * deviation - variance_[i]) / static_cast<float>(seen_[i] + 1);
    if (std::abs(deviation) <= tolerance) return;
    const bool unsure = seen_[i] < kStableHits;
    if ((deviation < 0.0F || unsure) && note_candidate(i, s, tolerance))
        adopt(i, candidate_[i], hits_[i]);
}

void ReferenceScene::uncover(std::span<const std::uint16_t> depth) {
    const auto product = static_cast<float>(scale_.product);
    for (std::size_t first = 0; first < depth.size(); first += unusual_.size()) {
        const std::size_t size = std::min(unusual_.size(), depth.size() - first);
        mark_uncovered(
            depth.data() + first, disparity_.data() + first, unusual_.data(), size, product
        );
        for_each_marked(std::span(unusual_).first(size), [&](std::size_t k) {
            const std::size_t i = first + k;
            if (seen_[i] == 0) return;
            const float s = product / static_cast<float>(depth[i]);
            if (note_candidate(i, s, band(s))) adopt(i, candidate_[i], hits_[i]);
        });
    }
}

RowRange ReferenceScene::follow(std::span<const std::uint16_t> depth) {
    const RowRange rows{height_ * next_strip_ / kStrips, height_ * (next_strip_ + 1) / kStrips};
    next_strip_ = (next_strip_ + 1) % kStrips;
    const auto first = static_cast<std::size_t>(rows.first) * static_cast<std::size_t>(width_);
    const auto size =
        static_cast<std::size_t>(rows.last - rows.first) * static_cast<std::size_t>(width_);
    follow_drift(
        {depth.data() + first, disparity_.data() + first, unusual_.data(), size},
        static_cast<float>(scale_.product),
        sigma_,
        rounding_
    );
    for_each_marked(std::span(unusual_).first(size), [&](std::size_t k) {
        follow_unusual(first + k, depth[first + k]);
    });
    return rows;
}

void ReferenceScene::follow_unusual(std::size_t i, std::uint16_t depth) {
    if (depth == 0) {
        if (seen_[i] == 0 || ++invalid_[i] < kInvalidVisits) return;
        seen_[i] = hits_[i] = invalid_[i] = 0;
        disparity_[i] = variance_[i] = 0.0F;
        return;
    }
    invalid_[i] = static_cast<std::uint8_t>(std::max(0, invalid_[i] - 2));
    // Where nothing was ever seen, what appears may be the object: only learn() may believe it.
    if (seen_[i] == 0) return;
    const auto s = static_cast<float>(scale_.steps(depth));
    if (note_candidate(i, s, band(s))) adopt(i, candidate_[i], hits_[i]);
}

bool ReferenceScene::note_candidate(std::size_t i, float s, float band) {
    if (hits_[i] > 0 && std::abs(s - candidate_[i]) <= band) {
        ++hits_[i];
        candidate_[i] += (s - candidate_[i]) / static_cast<float>(hits_[i]);
    } else {
        candidate_[i] = s;
        hits_[i] = 1;
    }
    return hits_[i] >= kStableHits;
}

void ReferenceScene::adopt(std::size_t i, float s, int hits) {
    disparity_[i] = s;
    seen_[i] = static_cast<std::uint8_t>(hits);
    variance_[i] = 0.0F;
    hits_[i] = 0;
}

}  // namespace kinectlab
