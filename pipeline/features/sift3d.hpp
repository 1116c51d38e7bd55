#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/features/voxel_surface.hpp"

namespace kinectlab {

/// Scale space in three dimensions over a voxelised surface (the paper's equation 5; Allaire, Kim,
/// Breen, Lee & Wyatt 2008 for the descriptor; Lowe 2004 for what both derive from).
struct Sift3dSettings {
    float smallest_scale_m = 0.006F;  ///< σ of the first blur; also the first octave's voxel
    int octaves = 3;                  ///< each twice the voxel of the one before
    int scales_per_octave = 3;        ///< layers in which extrema are looked for, 1 to 5
    float least_contrast = 0.015F;    ///< of the difference of Gaussians; values run from 0 to 1
};

/// An extremum of the difference of Gaussians over place and scale.
struct Keypoint3d {
    Eigen::Vector3f p_cam = Eigen::Vector3f::Zero();  ///< m
    float scale_m = 0.0F;                             ///< σ
    float response = 0.0F;                            ///< positive: darker than around
    std::uint8_t octave = 0;
    std::uint8_t layer = 0;   ///< which of the octave's blurs
    std::uint32_t voxel = 0;  ///< in that octave's surface
};

/// One octave: a surface and its values blurred more and more.
struct SurfaceOctave {
    static constexpr std::size_t kLanes = 8;  ///< blurs are computed side by side
    VoxelSurface surface;
    VoxelNeighbours neighbours;
    std::vector<float> blurred;  ///< kLanes for each voxel; scales_per_octave + 3 are used
};

/// All octaves. Voxels that no point lies in have no value; a blur is the weighted mean over those
/// that have, which is the Gaussian of equation 5 on the surface instead of in the empty space
/// around it.
[[nodiscard]] std::vector<SurfaceOctave> surface_scale_space(
    std::span<const ValuedPoint> points, const Sift3dSettings& settings
);

/// Extrema against up to 26 neighbours in their own and both neighbouring scales. Where fewer than
/// half of the neighbours that a flat surface has are there, the surface ends: no keypoint.
[[nodiscard]] std::vector<Keypoint3d> sift3d_keypoints(
    std::span<const SurfaceOctave> octaves, const Sift3dSettings& settings
);

/// 4 x 4 x 4 cells of 8 azimuths x 4 elevations of the gradient: 2,048 numbers of length 1.
constexpr std::size_t kSift3dLength = 4 * 4 * 4 * 8 * 4;

struct Descriptors3d {
    std::vector<std::uint32_t> keypoint;  ///< which each one describes; a keypoint may have two
    std::vector<float> numbers;           ///< kSift3dLength for each

    [[nodiscard]] std::size_t size() const { return keypoint.size(); }
    [[nodiscard]] std::span<const float> of(std::size_t i) const {
        return {numbers.data() + i * kSift3dLength, kSift3dLength};
    }
};

/// The frame of a descriptor: z along the surface's normal (towards the camera at the origin), x
/// along the dominant gradient across it. Allaire et al. take all three angles from the gradients
/// of a full volume; on a surface the normal fixes two of them better. Keypoints with too little
/// surface around get none.
[[nodiscard]] Descriptors3d sift3d_descriptors(
    std::span<const SurfaceOctave> octaves, std::span<const Keypoint3d> keypoints
);

}  // namespace kinectlab
