#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/features/curvature.hpp"

namespace kinectlab {

/// A local surface patch of Chen & Bhanu (2007): a point where the surface bends in its own way,
/// and what its neighbourhood looks like.
struct SurfacePatch {
    static constexpr int kIndexBins = 8;
    static constexpr int kAngleBins = 6;

    CurvedPoint keypoint;
    Eigen::Vector3d centroid_cam = Eigen::Vector3d::Zero();
    SurfaceType type = SurfaceType::flat;
    float mean_index = 0.0F;    ///< of the neighbourhood's shape index, 0 to 1
    float index_spread = 0.0F;  ///< its standard deviation
    /// Shape index x angle to the keypoint's normal, of the neighbourhood; sums to 1.
    std::array<float, static_cast<std::size_t>(kIndexBins* kAngleBins)> histogram{};
};

struct PatchSettings {
    double fit_radius_m = 0.015;   ///< of the quadratic surfaces
    double patch_radius_m = 0.04;  ///< of the neighbourhood
    double alpha = 0.10;  ///< a keypoint's index is so much above its surroundings' mean ...
    double beta = 0.10;   ///< ... or below
    std::size_t most_patches = 400;
};

/// The patches of a depth picture, most curved first. The picture is looked at on a grid of a third
/// of the fit's radius. The shape index of what is hardly curved is drawn towards 1/2, which it has
/// on the mean there: on a plane the index is nothing but noise.
[[nodiscard]] std::vector<SurfacePatch> find_surface_patches(
    std::span<const std::uint16_t> depth, const RgbdCamera& camera, const PatchSettings& settings
);

/// χ² between two histograms, 0 (equal) to 1.
[[nodiscard]] double patch_distance(const SurfacePatch& a, const SurfacePatch& b);

}  // namespace kinectlab
