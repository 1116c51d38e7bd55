#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/disparity.hpp"
#include "pipeline/preprocess/depth_cut.hpp"
#include "pipeline/preprocess/reference.hpp"
#include "pipeline/preprocess/settings.hpp"

namespace kinectlab {

/// Reference scene, noise and depth cut folded into one number a pixel, so that one comparison
/// tells whether something moved in front of it: changed if and only if 0 < depth < limit.
/// Stored less one, because then `depth - 1 < reach` in 16 bits is all of it (0 - 1 = 65535).
class ChangeLimits {
public:
    ChangeLimits(
        const RgbdCamera& camera, double threshold_steps, const DepthCutSettings& cut = {}
    );

    /// All rows, and the depth cut anew.
    void rebuild(const SceneView& reference);
    /// Some rows after the reference followed the scene there; the cut and each pixel's noise stay.
    void update(const SceneView& reference, RowRange rows);

    [[nodiscard]] std::span<const std::uint16_t> reach() const { return reach_; }
    /// 1 where a change can be believed: the scene was seen there, or nothing is there far and
    /// wide. 0 in narrow holes: at edges and in shadows sensors see phantoms that come and go.
    [[nodiscard]] std::span<const std::uint8_t> trusted() const { return trusted_; }
    [[nodiscard]] const std::optional<DepthCut>& cut() const { return cut_; }

private:
    void nearest_row(const SceneView& reference, int row, std::span<float> nearest);
    static void fill_holes(std::span<float> row, std::span<std::uint8_t> trusted);

    int width_, height_;
    DisparityScale scale_;
    float threshold_steps_;
    DepthCutSettings cut_settings_;
    std::optional<DepthCut> cut_;
    std::vector<std::uint16_t> reach_;
    std::vector<std::uint8_t> trusted_;
    std::vector<float> slack_, nearest_rows_, filled_;
};

}  // namespace kinectlab
