#pragma once

#include <array>
#include <vector>

#include "pipeline/track/identities.hpp"
#include "pipeline/track/outline_error.hpp"

namespace kinectlab {

/// How well the centroids of things that moved are known: the readings' noise, what each outline
/// does from frame to frame, and what other things hide. No allocation after the constructor. Not
/// thread-safe.
class ThingOutlines {
public:
    explicit ThingOutlines(const RgbdCamera& camera);

    /// To be called for each frame first.
    void next_frame();

    /// Covariance of the centroid of a thing that is seen in this frame, m²; `place` is its place
    /// in what `identities` returned. Once a frame for each thing.
    [[nodiscard]] Eigen::Matrix3d covariance(
        const Identities& identities,
        std::size_t place,
        const Thing& thing,
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved
    );

    /// Forgets all things.
    void reset();

private:
    struct Outline {
        std::uint32_t identity = 0;
        std::uint64_t frame = 0;         // in which it was seen last
        std::size_t begin = 0, end = 0;  // of its pixels in that frame
        OutlineError::Memory memory;
    };
    [[nodiscard]] Outline& outline_of(std::uint32_t identity);

    SurfacePoints surface_;
    double depth_unit_m_;
    OutlineError error_;
    std::array<Outline, Identities::kMostThings> outlines_{};
    std::vector<OutlineError::Pixel> now_, before_;  // those of one thing after another's
    std::uint64_t frame_ = 1;
};

}  // namespace kinectlab
