#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/features/grey_image.hpp"
#include "pipeline/features/keypoint2d.hpp"

namespace kinectlab {

/// Lowe 2004, with his values.
struct SiftSettings {
    bool doubled = true;          ///< the picture first, for the small things in it (3.3)
    int scales_per_octave = 3;    ///< layers in which extrema are looked for (3.2)
    float sigma = 1.6F;           ///< blur of an octave's first layer, px (3.3)
    float least_contrast = 3.4F;  ///< of a difference of Gaussians, of 255 (4)
    float most_edge = 10.0F;      ///< ratio of the principal curvatures; more is an edge (4.1)
};

/// The scale-invariant feature transform of a part of a picture: extrema of the difference of
/// Gaussians, refined to a fraction of a pixel, turned to their dominant gradient and described by
/// 4 x 4 x 8 gradient histograms. Keeps its buffers: no allocation once warm. Not thread-safe.
class Sift {
public:
    static constexpr std::size_t kLength = 128;
    using Descriptor = std::array<float, kLength>;  ///< of length 1

    explicit Sift(const SiftSettings& settings = {}) : settings_(settings) {}

    /// Looks at `region` of a picture with 3 bytes a pixel; regions under 16 px give nothing.
    void find(std::span<const std::uint8_t> rgb, int width, const ImageRegion& region);

    [[nodiscard]] std::span<const Keypoint2d> keypoints() const { return keypoints_; }
    /// One for each keypoint.
    [[nodiscard]] std::span<const Descriptor> descriptors() const { return descriptors_; }

private:
    void build();
    void find_extrema(int octave);
    void refine(int octave, int layer, int x, int y);
    void orient(const Keypoint2d& keypoint);
    void describe(const Keypoint2d& keypoint, Descriptor& descriptor);
    [[nodiscard]] const GreyImage& layer(int octave, int index) const {
        return layers_[static_cast<std::size_t>(
            octave * (settings_.scales_per_octave + 3) + index
        )];
    }
    [[nodiscard]] GreyImage& layer(int octave, int index) {
        return layers_[static_cast<std::size_t>(
            octave * (settings_.scales_per_octave + 3) + index
        )];
    }

    SiftSettings settings_;
    ImageRegion region_;
    int octaves_ = 0;
    GreyImage grey_, base_;
    std::vector<GreyImage> layers_;  ///< of all octaves
    std::vector<float> scratch_, rows_;
    std::vector<std::uint8_t> peaks_;
    std::array<std::vector<float>, 4> window_;  ///< of a descriptor
    std::vector<Keypoint2d> keypoints_;
    std::vector<Descriptor> descriptors_;
};

}  // namespace kinectlab
