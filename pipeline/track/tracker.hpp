#pragma once

#include <cstdint>
#include <memory>
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

    /// Adds its objects' samples; `moved` is sorted, biggest first. No allocation while `samples`
    /// has room. An object that is not found, or not surely, is "lost": never a guess.
    virtual void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) = 0;

    /// Forgets where the objects were.
    virtual void reset() = 0;
};

/// An object and its place in the list that a person gave.
struct IndexedSpec {
    std::uint32_t index = 0;
    ObjectSpec spec;
};

/// The trackers for a list of objects, one for each method in use. Errors name the object: none
/// given, a name twice or empty, an unknown method (with the nearest that exists), a radius that is
/// not positive, min_radius_m not below max_radius_m.
[[nodiscard]] Result<std::vector<std::unique_ptr<Tracker>>> make_trackers(
    const RgbdCamera& camera, std::span<const ObjectSpec> objects
);

/// The names of all methods, for messages and help.
[[nodiscard]] std::vector<std::string> tracking_methods();

}  // namespace kinectlab
