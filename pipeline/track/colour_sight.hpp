#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/features/colour_constancy.hpp"
#include "pipeline/features/two_cameras.hpp"
#include "pipeline/track/colour_bounds.hpp"
#include "pipeline/track/steep_sides.hpp"
#include "pipeline/track/surface_pieces.hpp"
#include "pipeline/track/surface_vote.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Where one frame shows a table's colours, as patches of depth pixels. Keeps its buffers; what it
/// returns is valid until the next call.
class ColourSight {
public:
    explicit ColourSight(const RgbdCamera& camera);

    /// To be called for each frame first. The first one's light is what others are compared with.
    void look(const RgbdFrame& frame);

    /// Patches of at least `fewest` pixels within an area, biggest first. `half_vote` (0 to 255) is
    /// what a pixel on the outline gets.
    [[nodiscard]] std::span<const MovedPixels> patches(
        const ColourTable& table, double half_vote, const PixelArea& area, std::size_t fewest
    );

    /// A patch of the last call with the steep sides that belong to it (see SteepSides).
    [[nodiscard]] MovedPixels with_sides(MovedPixels patch, double half_vote, double area_m2);

    /// How many of the pixels have a colour of the table.
    [[nodiscard]] std::size_t passing(const ColourTable& table, MovedPixels pixels) const;

    /// A byte a depth pixel, of the last call of `patches`.
    [[nodiscard]] std::span<const std::uint8_t> votes() const { return votes_; }
    /// The colour pixel of each depth pixel, -1 without one.
    [[nodiscard]] std::span<const std::int32_t> colour_index() const { return colour_index_; }
    [[nodiscard]] const ColourConstancy::Gains& gains() const { return gains_; }
    [[nodiscard]] PixelArea whole_picture() const;
    [[nodiscard]] PixelArea around(MovedPixels pixels) const;

    /// Forgets the light.
    void reset() { constancy_.reset(); }

private:
    [[nodiscard]] bool passes(const ColourTable& table, std::size_t pixel) const;

    RgbdCamera camera_;
    TwoCameras cameras_;
    SurfacePieces pieces_;
    SteepSides sides_;
    SurfaceVote vote_;
    ColourConstancy constancy_;
    ColourConstancy::Gains gains_{1.0F, 1.0F, 1.0F};
    ColourTable::Entry entry_{};
    const RgbdFrame* frame_ = nullptr;
    std::vector<std::int32_t> colour_index_;
    std::vector<std::uint8_t> mask_, votes_, patch_;
};

}  // namespace kinectlab
