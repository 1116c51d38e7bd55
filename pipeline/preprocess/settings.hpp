#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pipeline/core/error.hpp"
#include "pipeline/preprocess/moving_least_squares.hpp"
#include "pipeline/preprocess/outliers.hpp"

namespace kinectlab {

// How a frame is prepared before anything is looked for in it. Every method has a name, by which
// JSON chooses it; the enumerations are in the order of their names.

enum class CutMethod : std::uint8_t {
    wall,  ///< the far wall, found in the histogram of the scene's depths, is cut away; no wall, no
           ///< cut
    fixed,  ///< farthest_m
    none,
};
inline constexpr std::array<std::string_view, 3> kCutMethods{"wall", "fixed", "none"};

struct DepthCutSettings {
    CutMethod method = CutMethod::wall;
    double farthest_m = 4.0;  ///< of method fixed: what is farther does not count; above 0
};

enum class ReferenceMethod : std::uint8_t {
    scene,    ///< each pixel's farthest stable reading; drift is followed (ReferenceScene)
    rolling,  ///< the median of the last `seconds`: what rests for half of that becomes the scene
    median,   ///< the median of the first `seconds`, then as scene: objects may come and go
              ///< meanwhile
};
inline constexpr std::array<std::string_view, 3> kReferenceMethods{"scene", "rolling", "median"};

struct ReferenceSettings {
    ReferenceMethod method = ReferenceMethod::scene;
    double seconds = 2.0;  ///< of rolling and median; above 0, at most 3600
};

enum class ChangeMethod : std::uint8_t {
    image_grid,  ///< pixel by pixel in disparity: fast and sharp where the camera stands still
    octree,      ///< voxels that were empty (the paper's III.B.3), before what the noise hides
};
inline constexpr std::array<std::string_view, 2> kChangeMethods{"image_grid", "octree"};

struct ChangeDetectionSettings {
    ChangeMethod method = ChangeMethod::image_grid;
    double threshold_steps = 4.0;  ///< disparity steps nearer than the reference = moved
    double voxel_m = 0.05;         ///< octree: edge of a voxel
    int least_points = 5;          ///< octree: fewer points in a voxel are noise
};

struct PreprocessSettings {
    std::optional<OutlierSettings> outliers;              ///< statistical; none by default
    std::optional<MovingLeastSquaresSettings> smoothing;  ///< moving least squares; none by default
    DepthCutSettings depth_cut;
    ReferenceSettings reference;
    ChangeDetectionSettings change;
    int min_segment_points = 60;  ///< fewer changed neighbours are noise
};

/// Errors name the setting by its path in JSON, e.g. "preprocess.change.threshold_steps".
[[nodiscard]] Result<void> check(const PreprocessSettings& settings);

}  // namespace kinectlab
