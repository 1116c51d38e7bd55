#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/core/cloud.hpp"

namespace kinectlab {

/// The polynomial basis b(x) of the paper's equation 3.
enum class Basis : std::uint8_t {
    linear = 1,     ///< [1 x y]
    quadratic = 2,  ///< [1 x y xy x² y²]
};

struct MovingLeastSquaresSettings {
    Basis basis = Basis::quadratic;
    double radius_m = 0.02;  ///< neighbours count up to this distance; above 0
    /// ε of the weight θ(d) = 1/(d² + ε²); above 0. The smaller, the closer the surface keeps to
    /// each point: at the radius itself the farthest neighbour still weighs half as much as the
    /// point.
    double epsilon_m = 0.02;
    /// Neighbours in a picture may be radius_m + 3 σ_z nearer or farther, σ_z = this x z²: beyond
    /// that they belong to another surface. 1.645e-3 is a Kinect's (Khoshelham & Elberink 2012).
    double depth_noise_per_m = 1.645e-3;
};

/// The surface, and how each point came by it.
struct Smoothed {
    Cloud cloud;
    /// What was fitted: 2 quadratic, 1 linear, 0 the weighted mean, kNoFit where the point has no
    /// reading. The next simpler basis serves where fewer than two neighbours stand for each
    /// coefficient, or where they cannot tell the coefficients apart (all in a line).
    std::vector<std::uint8_t> fitted;

    static constexpr std::uint8_t kNoFit = 255;
};

/// Moving least squares (the paper's equations 1 to 4) on an organised cloud, camera frame, z
/// forward. The two-dimensional domain of equation 1 is the picture, scaled to metres at the
/// point's own depth; f is the depth. So the points move along their viewing rays, and the cloud
/// stays organised. Weights are the paper's for every neighbour; nothing is approximated. A cloud
/// without any reading comes back as it is. Errors: settings that are not positive numbers, a
/// radius of more than kMostPixels pixels at the nearest point, a cloud that is not the camera's
/// width x height or has readings that are not in front of it.
[[nodiscard]] Result<Smoothed> smooth_organised(
    const Cloud& cloud, const Pinhole& camera, const MovingLeastSquaresSettings& settings
);

/// The same for clouds from anywhere: the domain is the plane of least squares through the
/// neighbours within the radius, f the height above it (Levin's projection), so that no direction
/// is special. In clouds so dense that more than kMostNeighbours lie within the radius, some of
/// them, the nearer ones first, stand for all. Points with fewer than three neighbours stay where
/// they are (fitted = 0).
[[nodiscard]] Result<Smoothed> smooth_unorganised(
    const Cloud& cloud, const MovingLeastSquaresSettings& settings
);

constexpr int kMostPixels = 64;
constexpr int kMostNeighbours = 1024;

}  // namespace kinectlab
