#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/preprocess/change.hpp"

namespace kinectlab {

/// Pixels that moved together: connected in the picture and continuous in depth.
using PixelList = std::span<const std::uint32_t>;  ///< row-major indices, in reading order

/// Puts runs of changed pixels together to segments. Keeps its buffers: no allocation after the
/// constructor. Not thread-safe.
class Segmenter {
public:
    /// Segments of fewer than min_points trusted pixels, or of fewer rows than a run must have
    /// columns, are noise.
    Segmenter(const ChangeSettings& settings, int min_points);

    /// Biggest first, at most kMaxSegments. `trusted` is ChangeLimits::trusted(). Valid until the
    /// next call.
    [[nodiscard]] std::span<const PixelList> segment(
        std::span<const std::uint16_t> depth,
        std::span<const std::uint8_t> trusted,
        std::span<const ChangedRun> runs
    );

    static constexpr int kMaxSegments = 64;

private:
    struct Component {
        std::int32_t root = 0;
        std::int32_t points = 0;
        std::int32_t trusted = 0;  // points
        std::int32_t first_row = 0;
        std::int32_t last_row = 0;
    };
    void connect(std::span<const std::uint16_t> depth, std::span<const ChangedRun> runs);
    void measure(std::span<const std::uint8_t> trusted, std::span<const ChangedRun> runs);
    void emit(std::span<const ChangedRun> runs);
    [[nodiscard]] std::int32_t root_of(std::int32_t run);
    [[nodiscard]] bool touches(
        std::span<const std::uint16_t> depth, const ChangedRun& above, const ChangedRun& below
    ) const;

    ChangeSettings settings_;
    int min_points_;
    std::vector<std::int32_t> parent_, component_of_;
    std::vector<Component> components_;
    std::vector<std::uint32_t> pixels_;
    std::vector<PixelList> segments_;
};

}  // namespace kinectlab
