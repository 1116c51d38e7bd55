#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "pipeline/features/grey_image.hpp"
#include "pipeline/features/keypoint2d.hpp"
#include "pipeline/features/match.hpp"

namespace kinectlab {

/// Finds spots in pictures and tells which are the same, whichever way they are described. One
/// finder keeps the spots of one picture. Not thread-safe.
class SpotFinder {
public:
    SpotFinder() = default;
    SpotFinder(const SpotFinder&) = delete;
    SpotFinder& operator=(const SpotFinder&) = delete;
    virtual ~SpotFinder() = default;

    /// Looks at a region of a picture with 3 bytes a pixel and forgets what was there before.
    virtual void find(std::span<const std::uint8_t> rgb, int width, const ImageRegion& region) = 0;
    [[nodiscard]] virtual std::span<const Keypoint2d> spots() const = 0;

    /// Keeps only these spots, in this order.
    virtual void keep(std::span<const std::uint32_t> spots) = 0;

    /// How differently two spots look, 0 the same to 1; `other` is a finder of the same kind.
    [[nodiscard]] virtual float difference(
        std::uint32_t spot, const SpotFinder& other, std::uint32_t other_spot
    ) const = 0;

    /// The nearest in `scene` of each spot, where it is clearly the nearest.
    [[nodiscard]] virtual std::span<const Match> match_in(const SpotFinder& scene) = 0;

    /// Beyond this two spots are different ones even where the same is expected.
    [[nodiscard]] virtual float most_difference() const = 0;
};

[[nodiscard]] std::unique_ptr<SpotFinder> make_sift_finder();
[[nodiscard]] std::unique_ptr<SpotFinder> make_binary_finder();

}  // namespace kinectlab
