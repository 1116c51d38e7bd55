#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/track/shape_fit.hpp"

namespace kinectlab {

/// What to look for in a scene.
struct ShapesSettings {
    /// Planes, spheres, cylinders, cones.
    std::array<bool, 4> kinds{true, true, true, true};
    double min_radius_m = 0.01;  ///< of spheres and cylinders
    double max_radius_m = 0.30;
    int min_points = 400;  ///< pixels of the smallest shape of interest
    int max_shapes = 48;
    double miss_probability = 0.01;  ///< of the biggest shape not found yet, at each
};

/// A shape in a scene and the pixels that show it, row-major indices in reading order; no pixel
/// belongs to two.
struct SceneShape {
    ShapeFit fit;
    std::vector<std::uint32_t> pixels;
};

/// Finds the shapes of one depth picture, biggest first: efficient RANSAC (Schnabel, Wahl & Klein
/// 2007) in the image grid. Every 4th pixel in both directions becomes a point with its normal.
/// Minimal samples are drawn from neighbourhoods of random width; candidates are scored on random
/// subsets that grow until the best is sure; its largest connected part is refined on the pixels
/// themselves and taken away. What a simpler kind explains as well is of that kind.
/// Surfaces are seen from outside: the inside of a bowl is none. Keeps its buffers. Not
/// thread-safe.
class ShapeDetector {
public:
    /// Settings out of range are errors: radii that are not 0 < min < max <= 2 m, no kind at all,
    /// fewer than 50 points.
    [[nodiscard]] static Result<ShapeDetector> create(
        const RgbdCamera& camera, const ShapesSettings& settings = {}
    );
    ShapeDetector(ShapeDetector&&) noexcept;
    ShapeDetector& operator=(ShapeDetector&&) noexcept;
    ~ShapeDetector();

    /// `depth` has the camera's size; a picture of another size or without readings shows nothing.
    /// Valid until the next call.
    [[nodiscard]] std::span<const SceneShape> detect(std::span<const std::uint16_t> depth);

private:
    struct State;
    explicit ShapeDetector(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab
