#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/core/disparity.hpp"
#include "pipeline/core/error.hpp"

namespace kinectlab {

struct DepthPass {
    std::optional<double> cut_steps;  ///< disparity of the cut; nothing where no wall dominates
    std::uint16_t farthest = 65535;   ///< depth counts: what is farther was cut away
};

/// The pass-through filter in depth for a single frame without a reference (the paper's III.B.1):
/// finds the far wall in the frame's own histogram (wall_cut_steps, from every fourth reading: the
/// peak is the same) and writes to `near` the readings before it, 0 for the others. Without a wall
/// everything passes. `near` may be `depth` itself.
/// Errors: `near` of another size.
[[nodiscard]] Result<DepthPass> pass_nearer_than_wall(
    std::span<const std::uint16_t> depth, const DisparityScale& scale, std::span<std::uint16_t> near
);

}  // namespace kinectlab
