#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/features/colour_constancy.hpp"
#include "pipeline/features/hue.hpp"
#include "pipeline/track/object_spec.hpp"
#include "pipeline/track/surface_pieces.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Decides from one click or box which depth pixels show a thing and which its surroundings.
///   - A click on something that moved means all of that; else the surface around the click as far
///     as it is continuous and its colour is that of the click.
///   - A box means what moved within it, if that fills a fifth of it; else all of it.
///   - The surroundings lie around that, half as wide again to each side.
class FirstLook {
public:
    explicit FirstLook(const RgbdCamera& camera);

    /// `colour_index` is the colour pixel of every depth pixel, -1 where there is none. Refuses a
    /// place without depth and a thing too small or too large to follow; `field` names the place.
    [[nodiscard]] Result<void> take(
        const RgbdFrame& frame,
        std::span<const std::int32_t> colour_index,
        const ColourConstancy::Gains& gains,
        std::span<const MovedPixels> moved,
        const PictureBox& place,
        const std::string& field
    );

    [[nodiscard]] std::span<const std::uint32_t> pixels() const { return pixels_; }
    [[nodiscard]] std::span<const Hsv> inside() const { return inside_; }
    [[nodiscard]] std::span<const Hsv> outside() const { return outside_; }

private:
    void take_box(std::span<const MovedPixels> moved);
    void take_click(const RgbdFrame& frame, std::span<const MovedPixels> moved, std::uint32_t at);
    void grow(const RgbdFrame& frame, std::uint32_t at);
    void look_around(const PictureBox& place);
    [[nodiscard]] Hsv colour(std::uint32_t pixel) const;

    RgbdCamera camera_;
    SurfacePieces pieces_;
    const RgbdFrame* frame_ = nullptr;  // while take() runs
    std::span<const std::int32_t> colour_index_;
    ColourConstancy::Gains gains_{};
    std::vector<std::uint8_t> mask_;
    std::vector<std::uint32_t> pixels_;
    std::vector<Hsv> inside_, outside_;
};

/// A click is a box of one pixel.
[[nodiscard]] inline bool is_click(const PictureBox& box) {
    return box.width == 1 && box.height == 1;
}

}  // namespace kinectlab
