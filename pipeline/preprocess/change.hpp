#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinectlab {

/// Changed pixels side by side in one row, their depths continuous: columns [begin, end).
struct ChangedRun {
    std::int32_t row = 0;
    std::int32_t begin = 0;
    std::int32_t end = 0;
};

struct ChangeSettings {
    int width = 640;
    int height = 480;
    float product = 0.0F;           ///< DisparityScale::product
    float max_jump_steps = 8.0F;    ///< between neighbours on one surface, or
    float max_jump_share = 0.015F;  ///< of the disparity, whichever is more
    int min_run = 4;                ///< px; thinner is a string or a flickering edge
};

/// Whether two depth readings next to each other can lie on one surface.
[[nodiscard]] inline bool continuous(
    const ChangeSettings& settings, std::uint16_t depth_a, std::uint16_t depth_b
) {
    const float a = settings.product / static_cast<float>(depth_a);
    const float b = settings.product / static_cast<float>(depth_b);
    const float jump = a > b ? a - b : b - a;
    const float share = settings.max_jump_share * a;
    return jump <= (share > settings.max_jump_steps ? share : settings.max_jump_steps);
}

/// Finds the pixels nearer than their limit (ChangeLimits::reach), as runs in reading order.
/// `runs` is emptied first; reserve most_runs() once and it never allocates.
void find_changed(
    std::span<const std::uint16_t> depth,
    std::span<const std::uint16_t> reach,
    const ChangeSettings& settings,
    std::vector<ChangedRun>& runs
);

[[nodiscard]] std::size_t most_runs(const ChangeSettings& settings);

}  // namespace kinectlab
