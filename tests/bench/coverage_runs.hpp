#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab::bench {

enum class PositionNoise {
    white,
    lasting,  ///< of the same size, but each frame takes exp(-1/5) of the one before over
};

/// A recording whose truth is known, with everything that u claims to cover drawn anew for each
/// seed: the positions' noise (half a millimetre across the view, two along it), depth scale,
/// clock, tilt of the camera and every setting that has an uncertainty.
struct CoverageRun {
    Trajectory trajectory;
    AnalysisSettings settings;
    AnalysisConditions conditions;
    /// The true results of a motion that is seen from `start_s` on (s after the first sample).
    std::function<std::map<std::string, double>(double start_s)> truth;
};

/// Held, thrown and bounced: a foam ball of 6 cm whose drag is known to 10 %.
[[nodiscard]] CoverageRun thrown_ball(std::uint64_t seed, PositionNoise noise);

/// At rest, let go, rolled down 8° for 1.5 m; the angle is that of the path.
[[nodiscard]] CoverageRun rolling_ball(std::uint64_t seed, PositionNoise noise);

/// The same at 25° and sliding, the angle known to 0.3°.
[[nodiscard]] CoverageRun sliding_ball(std::uint64_t seed, PositionNoise noise);

/// 0.2 kg on 8 N/m, held, let go and damped by the speed and a little by its square, 30 s.
[[nodiscard]] CoverageRun free_spring(std::uint64_t seed, PositionNoise noise);

/// The same driven from rest at 0.9 Hz, 40 s.
[[nodiscard]] CoverageRun driven_spring(std::uint64_t seed, PositionNoise noise);

}  // namespace kinectlab::bench
