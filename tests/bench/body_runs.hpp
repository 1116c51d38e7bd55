#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab::bench {

enum class BodyNoise {
    white,  ///< new in every frame: 0.5 mm across the view, 2 mm along it, 10 mrad
    slow    ///< alike over five frames: 1 mm across the view, 5 mm along it, 15 mrad
};

/// A run whose truth is known, as a tracker would report it.
struct BodyRun {
    std::string method;
    std::vector<Trajectory> objects;
    AnalysisSettings settings;
    std::map<std::string, double> truth;  ///< by the names of the results
};

/// Two discs on a nearly level air table that meet off centre.
[[nodiscard]] BodyRun collision_run(std::uint64_t seed, BodyNoise noise);

/// A box in free flight that turns about its middle axis, for six seconds.
[[nodiscard]] BodyRun tumbler_run(std::uint64_t seed, BodyNoise noise);

/// A robot that drives an eight with changing speed, for twenty seconds, seen without its heading.
[[nodiscard]] BodyRun robot_run(std::uint64_t seed, BodyNoise noise);

}  // namespace kinectlab::bench
