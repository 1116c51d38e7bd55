#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/preprocess/scene_view.hpp"

namespace kinectlab {

/// Rows [first, last) of a picture.
struct RowRange {
    int first = 0;
    int last = 0;
};

/// The scene without the objects: for each pixel its farthest stable reading, in disparity steps.
/// An object can only come in front of what is there, so a farther reading that comes back is the
/// truth and the nearer one was an object. Drift within the noise is followed. A pixel that stops
/// giving readings for good is forgotten: what stood there is gone and nothing is seen behind it.
/// Allocates only when made. Not thread-safe.
class ReferenceScene {
public:
    explicit ReferenceScene(const RgbdCamera& camera);

    /// Takes in a whole frame: depth counts, row-major, 0 = no reading. Nearer readings are
    /// believed only against a pixel that was itself seen too rarely to be sure of.
    void learn(std::span<const std::uint16_t> depth);

    /// Takes from a whole frame only what an object uncovered: readings farther than the reference
    /// by more than noise or drift can be. For recordings, whose later frames are at hand early.
    void uncover(std::span<const std::uint16_t> depth);

    /// Takes in the next strip of a frame in which objects move, one of kStrips strips a call, and
    /// says which rows those were. Never moves a pixel nearer by more than drift.
    RowRange follow(std::span<const std::uint16_t> depth);

    /// Starts from a scene that is known already, as if it had been learned.
    void assign(const SceneView& scene);

    void reset();

    [[nodiscard]] SceneView view() const { return {disparity_, variance_, seen_}; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] std::size_t learned_frames() const { return learned_frames_; }

    /// Disparity in steps, row-major, 0 = never a stable reading.
    [[nodiscard]] std::span<const float> disparity() const { return disparity_; }
    /// Variance of the readings about it, steps²; from learned frames only.
    [[nodiscard]] std::span<const float> variance() const { return variance_; }
    /// How many readings it rests on, saturated at kMaxSeen.
    [[nodiscard]] std::span<const std::uint8_t> seen() const { return seen_; }

    static constexpr int kStrips = 16;   ///< follow() comes by every pixel twice a second at 30 Hz
    static constexpr int kMaxSeen = 32;  ///< readings averaged at most: older ones fade
    static constexpr int kStableHits = 3;  ///< readings that agree are stable

private:
    void learn_pixel(std::size_t i, float s);
    void follow_unusual(std::size_t i, std::uint16_t depth);
    void adopt(std::size_t i, float s, int hits);
    [[nodiscard]] bool note_candidate(std::size_t i, float s, float band);
    [[nodiscard]] float band(float s) const;

    int width_, height_;
    DisparityScale scale_;
    float sigma_, rounding_;  // of a reading at disparity s: sigma + rounding·s² at most
    std::size_t learned_frames_ = 0;
    int next_strip_ = 0;
    std::vector<float> disparity_, variance_, candidate_;
    std::vector<std::uint8_t> seen_, hits_, invalid_, unusual_;
};

}  // namespace kinectlab
