#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/core/disparity.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/preprocess/depth_cut.hpp"

namespace kinectlab {

struct DepthPass {
    std::optional<DepthCut> cut;     ///< nothing where no wall dominates
    std::uint16_t farthest = 65535;  ///< depth counts: what is farther was cut away, all over the
                                     ///< picture; 65535 where nothing was or the wall is slanted
};

/// The pass-through filter in depth for a single frame without a reference (the paper's III.B.1):
/// finds the far wall in the frame's own histogram (wall_cut, from every eighth row: the
/// peak is the same) and writes to `near` the readings before it, 0 for the others. Without a wall
/// everything passes. `depth` has rows of `width` counts, 0 = no reading. `near` may be `depth`
/// itself. Errors: `near` of another size; a width that the picture is no multiple of.
[[nodiscard]] Result<DepthPass> pass_nearer_than_wall(
    std::span<const std::uint16_t> depth,
    int width,
    const DisparityScale& scale,
    std::span<std::uint16_t> near
);

}  // namespace kinectlab
