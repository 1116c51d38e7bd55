#include "pipeline/features/spot_finder.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/features/binary_keypoints.hpp"
#include "pipeline/features/sift.hpp"

namespace kinectlab {
namespace {

/// Half the distance of unit vectors, 0 to 1.
KINECTLAB_HOT_LOOP void sift_distances(
    const Sift::Descriptor& one, const Sift::Descriptor* others, std::size_t count, float* out
) {
    constexpr std::size_t kLanes = 16;
    for (std::size_t at = 0; at < count; ++at) {
        const Sift::Descriptor& other = others[at];
        float sums[kLanes] = {};
        for (std::size_t i = 0; i < Sift::kLength; i += kLanes)
            for (std::size_t lane = 0; lane < kLanes; ++lane)
                sums[lane] += one[i + lane] * other[i + lane];
        float sum = 0.0F;
        for (const float part : sums)
            sum += part;
        out[at] = std::sqrt(std::max(0.0F, 0.5F - 0.5F * sum));
    }
}

/// Share of the comparisons that differ. Hot for the sake of the processor's own bit counting.
KINECTLAB_HOT_LOOP void binary_distances(
    const BinaryKeypoints::Descriptor& one,
    const BinaryKeypoints::Descriptor* others,
    std::size_t count,
    float* out
) {
    for (std::size_t at = 0; at < count; ++at) {
        int bits = 0;
        for (std::size_t i = 0; i < one.size(); ++i)
            bits += __builtin_popcountll(one[i] ^ others[at][i]);
        out[at] = static_cast<float>(bits) / 256.0F;
    }
}

struct SiftKind {
    using Finder = Sift;
    static constexpr float kRatio = 0.8F;
    static constexpr float kMostDifference = 0.45F;
    static constexpr auto kDistances = sift_distances;
};

struct BinaryKind {
    using Finder = BinaryKeypoints;
    static constexpr float kRatio = 0.8F;
    static constexpr float kMostDifference = 0.27F;
    static constexpr auto kDistances = binary_distances;
};

template <class Kind>
class Finder : public SpotFinder {
public:
    void find(std::span<const std::uint8_t> rgb, int width, const ImageRegion& region) override {
        finder_.find(rgb, width, region);
        keypoints_.assign(finder_.keypoints().begin(), finder_.keypoints().end());
        descriptors_.assign(finder_.descriptors().begin(), finder_.descriptors().end());
    }

    [[nodiscard]] std::span<const Keypoint2d> spots() const override { return keypoints_; }

    void keep(std::span<const std::uint32_t> spots) override {
        std::vector<Keypoint2d> keypoints;
        std::vector<typename Kind::Finder::Descriptor> descriptors;
        for (const auto i : spots) {
            keypoints.push_back(keypoints_[i]);
            descriptors.push_back(descriptors_[i]);
        }
        keypoints_.swap(keypoints);
        descriptors_.swap(descriptors);
    }

    [[nodiscard]] float difference(
        std::uint32_t spot, const SpotFinder& other, std::uint32_t other_spot
    ) const override {
        const auto& same_kind = dynamic_cast<const Finder&>(other);
        float difference = 0.0F;
        Kind::kDistances(descriptors_[spot], &same_kind.descriptors_[other_spot], 1, &difference);
        return difference;
    }

    [[nodiscard]] std::span<const Match> match_in(const SpotFinder& scene) override {
        const auto& other = dynamic_cast<const Finder&>(scene);
        match_nearest(
            descriptors_.size(),
            other.descriptors_.size(),
            Kind::kRatio,
            [&](std::uint32_t m, float* out) {
                const auto& scenes = other.descriptors_;
                Kind::kDistances(descriptors_[m], scenes.data(), scenes.size(), out);
            },
            [&](std::uint32_t s, std::uint32_t t) {
                const auto& a = other.keypoints_[s];
                const auto& b = other.keypoints_[t];
                return std::hypot(a.u - b.u, a.v - b.v) < a.scale_px + b.scale_px;
            },
            matches_
        );
        return matches_;
    }

    [[nodiscard]] float most_difference() const override { return Kind::kMostDifference; }

private:
    typename Kind::Finder finder_;
    std::vector<Keypoint2d> keypoints_;
    std::vector<typename Kind::Finder::Descriptor> descriptors_;
    std::vector<Match> matches_;
};

}  // namespace

std::unique_ptr<SpotFinder> make_sift_finder() {
    return std::make_unique<Finder<SiftKind>>();
}

std::unique_ptr<SpotFinder> make_binary_finder() {
    return std::make_unique<Finder<BinaryKind>>();
}

}  // namespace kinectlab
