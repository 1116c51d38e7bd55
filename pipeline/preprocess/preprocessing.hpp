#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/preprocess/change.hpp"
#include "pipeline/preprocess/change_limits.hpp"
#include "pipeline/preprocess/cleaner.hpp"
#include "pipeline/preprocess/median_reference.hpp"
#include "pipeline/preprocess/reference.hpp"
#include "pipeline/preprocess/segment.hpp"
#include "pipeline/preprocess/settings.hpp"
#include "pipeline/preprocess/voxel_change.hpp"

namespace kinectlab {

/// The stage before tracking, as the settings choose it: clean → cut and change against the
/// reference → segments. For each frame clean(), moved(), follow(), in this order. No allocation
/// once warm, if frames are not cleaned and change is found in the image grid. Not thread-safe.
class Preprocessing {
public:
    /// `settings` were checked.
    Preprocessing(const RgbdCamera& camera, const PreprocessSettings& settings);

    /// Takes a frame into the reference, as it is: what cleaning removes now and then would be a
    /// hole in the scene, and what shows in a hole counts as an object.
    void learn(const RgbdFrame& frame);

    /// Takes into a fixed reference scene what an object uncovered; into no other.
    void uncover(const RgbdFrame& frame);

    /// What is to be looked at instead of the frame (FrameCleaner::clean).
    [[nodiscard]] Result<const RgbdFrame*> clean(const RgbdFrame& frame) {
        return cleaner_.clean(frame);
    }
    /// What moved in a cleaned frame, biggest first. Valid until the next call. Something must have
    /// been learned.
    [[nodiscard]] Result<std::span<const PixelList>> moved(const RgbdFrame& clean);
    /// Lets the reference follow the scene; the frame as it came.
    void follow(const RgbdFrame& frame);

    void reset();
    [[nodiscard]] std::size_t learned_frames() const { return learned_; }

private:
    void update_median(const RgbdFrame& frame);
    [[nodiscard]] SceneView scene() const;
    [[nodiscard]] Result<std::span<const std::uint16_t>> reach_of(const RgbdFrame& clean);

    ReferenceMethod reference_method_;
    FrameCleaner cleaner_;
    ReferenceScene reference_;
    std::optional<MedianReference> median_;  // of rolling, and of median
    bool median_rules_ = false;              // reference_ is not in use, or not yet
    ChangeLimits limits_;
    std::optional<VoxelChange> voxels_;
    bool scene_is_new_ = true;
    int followed_ = 0;  // strips since the voxels were made
    ChangeSettings change_;
    Segmenter segmenter_;
    std::vector<ChangedRun> runs_;
    std::size_t learned_ = 0;
};

}  // namespace kinectlab
