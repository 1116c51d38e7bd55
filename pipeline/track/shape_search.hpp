#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape.hpp"
#include "pipeline/track/shape_support.hpp"

namespace kinectlab {

/// What is known of a radius (m) or of a cone's angle (rad) beforehand.
struct SizeLimits {
    std::optional<double> known;
    double least = 0.01;
    double most = 0.30;

    /// A sample may be as far out as its normals are rough.
    [[nodiscard]] bool may_be(double size) const {
        return known ? size > 0.5 * *known && size < 2.0 * *known
                     : size > 0.6 * least && size < 1.6 * most;
    }
};

/// Marsaglia's xorshift: a fixed seed makes every run of a recording the same.
class ShapeRandom {
public:
    explicit ShapeRandom(std::uint32_t seed = 2463534242U) : state_(seed) {}
    std::uint32_t next() {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 17;
        state_ ^= state_ << 5;
        return state_;
    }
    std::size_t below(std::size_t n) { return next() % n; }

private:
    std::uint32_t state_;
};

struct ShapeCandidate {
    Shape shape;
    int support = 0;  ///< points that hold
};

/// A shape of one kind through a minimal sample, its size within limits and known if it is; nothing
/// if the sample's own normals disagree with it.
[[nodiscard]] std::optional<Shape> propose(
    ShapeKind kind, std::span<const OrientedPoint> sample, const SizeLimits& limits
);

/// How long to look.
struct SearchEffort {
    int most_tries = 256;
    std::size_t most_found = 3;
    int least_tries = 0;
    std::uint32_t seed = 2463534242U;
};

/// RANSAC over one thing's points: the shapes that most of them support, best first. Draws until a
/// better one is unlikely to be missed (Fischler & Bolles 1981).
void search_shape(
    ShapeKind kind,
    const SurfacePoints& points,
    const SizeLimits& limits,
    const Tolerance& tolerance,
    const SearchEffort& effort,
    std::vector<ShapeCandidate>& best
);

}  // namespace kinectlab
