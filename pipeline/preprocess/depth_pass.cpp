#include "pipeline/preprocess/depth_pass.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/preprocess/depth_cut.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kEvery = 8;

KINECTLAB_HOT_LOOP void sample_disparity(
    const std::uint16_t* depth, int width, float product, float* disparity
) {
    for (int i = 0; i < width; ++i) {
        const auto counts = static_cast<float>(static_cast<int>(depth[i]));
        disparity[i] = counts > 0.0F ? product / counts : 0.0F;
    }
}

KINECTLAB_HOT_LOOP void keep_nearer(
    const std::uint16_t* depth, std::size_t size, std::uint16_t farthest, std::uint16_t* near
) {
    for (std::size_t i = 0; i < size; ++i)
        near[i] = static_cast<std::uint16_t>(depth[i] <= farthest ? depth[i] : 0);
}

/// Keeps what is nearer than the plane: counts x plane <= product.
KINECTLAB_HOT_LOOP void keep_nearer_than_plane(
    const std::uint16_t* depth,
    int width,
    float first,
    float per_column,
    float product,
    std::uint16_t* near
) {
    for (int u = 0; u < width; ++u) {
        const auto counts = static_cast<float>(static_cast<int>(depth[u]));
        const float plane = first + per_column * static_cast<float>(u);
        near[u] = static_cast<std::uint16_t>(counts * plane <= product ? depth[u] : 0);
    }
}

/// The greatest depth whose disparity is not below the cut.
std::uint16_t farthest_of(const DepthCut& cut, const DisparityScale& scale) {
    return static_cast<std::uint16_t>(
        std::clamp(std::floor(scale.product / cut.at_origin), 0.0, 65535.0)
    );
}

Result<void> check(std::size_t pixels, int width, std::size_t room) {
    if (room != pixels)
        return fail(
            ErrorCode::invalid_argument,
            "near",
            "has " + std::to_string(room) + " pixels",
            "give as many as the frame has: " + std::to_string(pixels)
        );
    if (width < 1 || pixels % static_cast<std::size_t>(width) != 0)
        return fail(
            ErrorCode::invalid_argument,
            "width",
            "is " + std::to_string(width) + " in a picture of " + std::to_string(pixels) +
                " pixels",
            "give the pixels of a row"
        );
    return {};
}

/// Every kEvery-th row.
std::vector<float> thinned(std::span<const std::uint16_t> depth, int width, float product) {
    const auto row = static_cast<std::size_t>(width);
    const std::size_t step = kEvery * row;
    std::vector<float> disparity((depth.size() + step - row) / step * row);
    for (std::size_t v = 0; v * row < disparity.size(); ++v)
        sample_disparity(depth.data() + v * step, width, product, disparity.data() + v * row);
    return disparity;
}

}  // namespace

Result<DepthPass> pass_nearer_than_wall(
    std::span<const std::uint16_t> depth,
    int width,
    const DisparityScale& scale,
    std::span<std::uint16_t> near
) {
    if (auto ok = check(depth.size(), width, near.size()); !ok) return tl::unexpected(ok.error());
    const auto product = static_cast<float>(scale.product);
    DepthPass pass;
    pass.cut = wall_cut(thinned(depth, width, product), width, kEvery);
    if (!pass.cut || pass.cut->level()) {
        if (pass.cut) pass.farthest = farthest_of(*pass.cut, scale);
        keep_nearer(depth.data(), depth.size(), pass.farthest, near.data());
        return pass;
    }
    const auto row = static_cast<std::size_t>(width);
    for (std::size_t v = 0; v * row < depth.size(); ++v)
        keep_nearer_than_plane(
            depth.data() + v * row,
            width,
            static_cast<float>(pass.cut->steps(0.0, static_cast<double>(v))),
            static_cast<float>(pass.cut->per_column),
            product,
            near.data() + v * row
        );
    return pass;
}

}  // namespace kinectlab
