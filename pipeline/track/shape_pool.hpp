#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape_grid.hpp"
#include "pipeline/track/shape_search.hpp"
#include "pipeline/track/shape_support.hpp"

namespace kinectlab {

/// Candidates for the shapes of a scene: minimal samples from neighbourhoods of random width,
/// scored on random subsets of the points that grow until the best is sure (Schnabel et al.
/// 2007, 4.5.1).
class ShapePool {
public:
    struct Rules {
        std::array<bool, 4> kinds{};
        std::array<SizeLimits, 4> limits{};
        double least_points = 0.0;  ///< of the smallest shape of interest
        double miss_probability = 0.01;
        Tolerance tolerance;
    };
    explicit ShapePool(const Rules& rules) : rules_(rules) {}

    /// Forgets everything; every picture is searched with the same random numbers.
    void begin();
    /// Draws further samples. The points are in random order.
    void draw(const SurfacePoints& points, const ShapeGrid& grid);
    [[nodiscard]] bool is_empty() const { return pool_.empty(); }
    [[nodiscard]] double draws() const { return draws_; }

    /// Whether a shape of so many of the points may not have been drawn yet.
    [[nodiscard]] bool may_have_missed(double support, std::size_t points) const;
    /// Looks at more points of the leading candidates until none can be better than the best.
    std::size_t sure_best(const SurfacePoints& points);
    [[nodiscard]] double support_of(std::size_t i) const { return pool_[i].bounds.middle; }
    [[nodiscard]] Shape take(std::size_t i);
    /// Scores what is left anew, after points were taken away.
    void look_again(const SurfacePoints& points);

private:
    /// A candidate and what is known of its support.
    struct Pooled {
        Shape shape;
        std::size_t seen = 0;  // points of the random order that were looked at
        int found = 0;
        SupportBounds bounds;
    };
    using Sample = std::array<OrientedPoint, 4>;
    [[nodiscard]] std::optional<Sample> draw_sample(
        const SurfacePoints& points, const ShapeGrid& grid
    );
    void look(Pooled& one, std::size_t until, const SurfacePoints& points) const;
    void enter(const Pooled& one);

    Rules rules_;
    ShapeRandom random_;
    double draws_ = 0.0;
    std::vector<Pooled> pool_;
};

}  // namespace kinectlab
