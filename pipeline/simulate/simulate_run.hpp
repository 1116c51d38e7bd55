#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "pipeline/core/error.hpp"
#include "pipeline/simulate/simulated_rig.hpp"

namespace kinectlab::simulate {

struct RunSettings {
    RigSettings rig;
    std::optional<double> displacement;  ///< rad or m, as the apparatus says; by default its usual
    double seconds = 30.0;               ///< of free motion; 0.1 to 86400
    double rest_s = 2.0;                 ///< before it, at rest: the frames of the reference scene
    double held_s = 1.0;                 ///< between displacing and releasing
};

struct RunSummary {
    std::uint64_t frames = 0;      ///< in all
    std::uint64_t first_free = 0;  ///< index of the first frame after the release
    double release_s = 0.0;        ///< after the first frame
};

/// Receives every frame with its truth; an error stops the run and is handed on.
using FrameSink = std::function<Result<void>(const RgbdFrame& frame, const Truth& truth)>;

/// At rest, displaced, held, released, free; what rests in view is held aside before that where it
/// has to be, so that the frames show all that it hides at rest: frame k at rig.start + k/30 s, as
/// fast as the machine can. Same settings, same frames.
[[nodiscard]] Result<RunSummary> simulate_run(const RunSettings& settings, const FrameSink& sink);

}  // namespace kinectlab::simulate
