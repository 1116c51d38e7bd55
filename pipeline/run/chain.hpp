#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/preprocess/settings.hpp"
#include "pipeline/track/object_spec.hpp"

namespace kinectlab {

struct ChainSettings {
    RgbdCamera camera;
    std::vector<ObjectSpec> objects;
    PreprocessSettings preprocess;
};

/// Frames in, poses out: clean → cut → change → segments → track. No allocation once warm, with the
/// pre-processing's defaults. Not thread-safe: one thread owns a chain.
///
/// The reference scene (ReferenceMethod::scene) is learned, then kept: feed frames of the scene
/// with learn(), any number, also while the object is held somewhere or swings; a pixel's reference
/// is its farthest stable reading, because an object can only come in front of what is there.
/// track() goes on learning where a pixel shows something persistently farther, so that an object
/// that rested in the first frames does not leave a hole in its own path.
class Chain {
public:
    /// Refuses settings out of range, unknown methods, radii that are not positive, no objects.
    [[nodiscard]] static Result<Chain> create(ChainSettings settings);

    Chain(Chain&&) noexcept;
    Chain& operator=(Chain&&) noexcept;
    ~Chain();

    /// A frame whose size does not fit the camera is refused.
    [[nodiscard]] Result<void> learn(const RgbdFrame& frame);

    /// Learns only what the frame shows behind things that stood there in the learned ones; only
    /// for a fixed reference scene.
    [[nodiscard]] Result<void> uncover(const RgbdFrame& frame);

    /// One sample for each object (method "change": one for each thing known, biggest first, with
    /// its identity); status is tracked or lost. The span is valid until the next call. A setting
    /// that turns out wrong once a frame is seen, as a click where there is no depth, is refused.
    [[nodiscard]] Result<std::span<const TrackSample>> track(const RgbdFrame& frame);

    /// Forgets the reference: the camera or the scene was moved.
    void reset();

    [[nodiscard]] std::size_t learned_frames() const;

private:
    struct State;
    explicit Chain(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab
