#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/track/object_spec.hpp"

namespace kinectlab {

/// Pixels of one thing that moved: row-major indices in reading order.
using MovedPixels = std::span<const std::uint32_t>;

/// Finds the objects of one method in each frame. Not thread-safe; frames in the order of time.
class Tracker {
public:
    Tracker() = default;
    Tracker(const Tracker&) = delete;
    Tracker& operator=(const Tracker&) = delete;
    virtual ~Tracker() = default;

    /// Adds its objects' samples to those of the trackers before it; `moved` is sorted, biggest
    /// first. No allocation while `samples` has room. An object that is not found, or not surely,
    /// is "lost": never a guess.
    virtual void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) = 0;

    /// What is wrong with a setting that only a frame could tell, as a place without depth; told
    /// once, after the frame in which it was found.
    [[nodiscard]] virtual std::optional<Error> take_fault() { return std::nullopt; }

    /// Forgets where the objects were.
    virtual void reset() = 0;
};

/// An object of one method and its place in the list that a person gave.
template <class Settings>
struct TrackedObject {
    std::uint32_t index = 0;
    std::string name;
    Settings settings;
};

template <class Settings>
using TrackedObjects = std::vector<TrackedObject<Settings>>;

/// The trackers for a list of objects, one for each method in use. Errors name the object and the
/// setting: none given, a name twice or empty, a setting that its method refuses.
[[nodiscard]] Result<std::vector<std::unique_ptr<Tracker>>> make_trackers(
    const RgbdCamera& camera, std::span<const ObjectSpec> objects
);

}  // namespace kinectlab
