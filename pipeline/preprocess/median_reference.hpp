#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/time.hpp"
#include "pipeline/preprocess/scene_view.hpp"

namespace kinectlab {

/// The scene as the median of the pictures of a span of time: what stays in a place for less than
/// half of it leaves no trace there, whether it is nearer or farther. Of the readings within 4σ of
/// the median the mean is taken, so that the noise falls as well. A pixel with readings in less
/// than half of the pictures is unknown. Keeps kPictures pictures, evenly spaced in time. Allocates
/// only when made. Not thread-safe.
class MedianReference {
public:
    /// Of a span of `seconds` above 0.
    MedianReference(const RgbdCamera& camera, double seconds);

    /// Depth counts, row-major, 0 = no reading, in the order of time. Takes the picture if it is
    /// time for one and says whether it did. Pictures older than the span are dropped, but for the
    /// last kLeastPictures.
    bool add(std::span<const std::uint16_t> depth, TimeNs t);

    /// Recalculates what view() shows.
    void update();
    [[nodiscard]] SceneView view() const { return {disparity_, variance_, seen_}; }

    /// Whether the first picture is a whole span older than `t`.
    [[nodiscard]] bool complete(TimeNs t) const { return pictures_ > 0 && t - first_ >= span_; }

    void reset();

    static constexpr int kPictures = 9;
    static constexpr int kLeastPictures = 3;

private:
    DisparityScale scale_;
    TimeNs span_, first_ = 0;
    int pictures_ = 0;  ///< in the ring
    int next_ = 0;
    std::array<std::vector<std::uint16_t>, kPictures> ring_;
    std::array<TimeNs, kPictures> taken_{};
    std::vector<float> disparity_, variance_;
    std::vector<std::uint8_t> seen_;
};

}  // namespace kinectlab
