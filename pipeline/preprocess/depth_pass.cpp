#include "pipeline/preprocess/depth_pass.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/preprocess/depth_cut.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kEvery = 4;

KINECTLAB_HOT_LOOP void sample_disparity(
    const std::uint16_t* depth, std::size_t samples, float product, float* disparity
) {
    for (std::size_t i = 0; i < samples; ++i) {
        const auto counts = static_cast<float>(static_cast<int>(depth[kEvery * i]));
        disparity[i] = counts > 0.0F ? product / counts : 0.0F;
    }
}

KINECTLAB_HOT_LOOP void keep_nearer(
    const std::uint16_t* depth, std::size_t size, std::uint16_t farthest, std::uint16_t* near
) {
    for (std::size_t i = 0; i < size; ++i)
        near[i] = static_cast<std::uint16_t>(depth[i] <= farthest ? depth[i] : 0);
}

/// The greatest depth whose disparity is not below the cut.
std::uint16_t farthest_of(double cut_steps, const DisparityScale& scale) {
    return static_cast<std::uint16_t>(
        std::clamp(std::floor(scale.product / cut_steps), 0.0, 65535.0)
    );
}

}  // namespace

Result<DepthPass> pass_nearer_than_wall(
    std::span<const std::uint16_t> depth, const DisparityScale& scale, std::span<std::uint16_t> near
) {
    if (near.size() != depth.size())
        return fail(
            ErrorCode::invalid_argument,
            "near",
            "has " + std::to_string(near.size()) + " pixels",
            "give as many as the frame has: " + std::to_string(depth.size())
        );
    std::vector<float> disparity(depth.size() / kEvery);
    sample_disparity(
        depth.data(), disparity.size(), static_cast<float>(scale.product), disparity.data()
    );
    DepthPass pass;
    pass.cut_steps = wall_cut_steps(disparity);
    if (pass.cut_steps) pass.farthest = farthest_of(*pass.cut_steps, scale);
    keep_nearer(depth.data(), depth.size(), pass.farthest, near.data());
    return pass;
}

}  // namespace kinectlab
