#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/features/grey_image.hpp"
#include "pipeline/features/keypoint2d.hpp"

namespace kinectlab {

struct BinarySettings {
    int levels = 5;                ///< of the pyramid
    float level_ratio = 1.3F;      ///< of the sizes of neighbouring levels
    float least_contrast = 12.0F;  ///< of the ring to its middle, of 255 (FAST's threshold)
    int most_keypoints = 1200;     ///< the clearest are kept
};

/// The fast way to find a spot again: corners by FAST (Rosten & Drummond 2006: 9 of the 16 pixels
/// of a ring all brighter or all darker than the middle) in a pyramid, turned to their intensity
/// centroid, described by 256 comparisons of smoothed pixels in a turned pattern (BRIEF, Calonder
/// et al. 2010; the turning is that of ORB, Rublee et al. 2011). Faster than SIFT;
/// bears less change of size and view. Keeps its buffers. Not thread-safe.
class BinaryKeypoints {
public:
    using Descriptor = std::array<std::uint64_t, 4>;

    explicit BinaryKeypoints(const BinarySettings& settings = {});

    /// Looks at `region` of a picture with 3 bytes a pixel; regions under 48 px give nothing.
    void find(std::span<const std::uint8_t> rgb, int width, const ImageRegion& region);

    [[nodiscard]] std::span<const Keypoint2d> keypoints() const { return keypoints_; }
    /// One for each keypoint.
    [[nodiscard]] std::span<const Descriptor> descriptors() const { return descriptors_; }

private:
    struct Pair {
        float ax, ay, bx, by;
    };
    void find_corners(int level, float ratio, const ImageRegion& region);
    void describe(const Keypoint2d& keypoint, Descriptor& descriptor) const;

    BinarySettings settings_;
    std::array<Pair, 256> pattern_;
    std::vector<GreyImage> levels_, smooth_;
    std::vector<float> scratch_, scores_;
    std::vector<Keypoint2d> keypoints_;
    std::vector<Descriptor> descriptors_;
};

}  // namespace kinectlab
