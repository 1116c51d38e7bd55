#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/track/shape_fit.hpp"
#include "pipeline/track/shape_pair.hpp"
#include "pipeline/track/shape_search.hpp"
#include "pipeline/track/shape_tracker.hpp"
#include "pipeline/track/shapes.hpp"

namespace kinectlab {

inline constexpr double kLeastConeAngle = 0.087;  // rad, 5°: a slimmer one is a cylinder
inline constexpr double kMostConeAngle = 1.222;   // 70°: a flatter one is a plane

/// Finds one shape of a wanted kind: guess, refinement, and the proof that it is that kind. Keeps
/// its buffers. Not thread-safe.
class SegmentShapes {
public:
    explicit SegmentShapes(const RgbdCamera& camera);

    /// In one segment's pixels. Nothing if the segment shows no such shape, or if another kind of
    /// shape explains it better or a simpler one as well.
    [[nodiscard]] std::optional<ShapeFit> in_segment(
        const DisparityImage& image,
        std::span<const std::uint32_t> pixels,
        const ShapeTarget& target
    );

    /// How much a fit is wanted; not at all at 0.
    using Worth = std::function<double(const ShapeFit&)>;

    /// In the whole picture by Hough's votes; planes and spheres only. What lies on a shape that is
    /// taken votes for none. Of several the most wanted, which is the biggest if not said
    /// otherwise.
    [[nodiscard]] std::optional<ShapeFit> in_scene(
        const DisparityImage& image,
        const ShapeTarget& target,
        std::span<const Shape> taken = {},
        const Worth& worth = [](const ShapeFit& fit) { return fit.quality.points; }
    );

    /// A shape of a scene refined once more with its size known.
    [[nodiscard]] std::optional<ShapeFit> with_known_size(
        const DisparityImage& image, const SceneShape& found, double size
    );

private:
    void sample(const DisparityImage& image, std::span<const std::uint32_t> pixels);
    void guess(const ShapeTarget& target, const SearchEffort& effort);
    [[nodiscard]] std::optional<ShapeFit> best_guess(
        const DisparityImage& image, const ShapeTarget& target
    );
    [[nodiscard]] bool is_sound(const ShapeFit& fit, const ShapeTarget& target) const;
    [[nodiscard]] bool is_its_kind(const DisparityImage& image, const ShapeFit& fit);
    [[nodiscard]] double best_cost(const DisparityImage& image, ShapeKind kind, double hopeless);
    [[nodiscard]] bool is_flat(const DisparityImage& image, const ShapeFit& ball);
    [[nodiscard]] bool is_faces(const DisparityImage& image, const ShapeFit& fit);
    [[nodiscard]] double cost_on(const DisparityImage& image, const ShapeFit& fit, std::size_t n);
    [[nodiscard]] bool lies_on(const DisparityImage& image, const Shape& shape, std::uint32_t pixel)
        const;
    [[nodiscard]] bool is_passed_by(const DisparityImage& image, std::uint32_t pixel) const;
    void vote(const DisparityImage& image, const ShapeTarget& target);
    void near_pixels(const DisparityImage& image, const Shape& shape);

    RgbdCamera camera_;
    DisparityScale scale_;
    ShapeFitter fitter_, rival_;  // the rivals' misfit must not teach the noise
    PlanePair pair_;
    SurfacePoints points_, own_;
    std::vector<std::uint32_t> places_, compared_, near_;
    std::vector<Shape> passed_by_, unwanted_;  // in a scene by votes
    std::vector<ShapeCandidate> guesses_;
};

}  // namespace kinectlab
