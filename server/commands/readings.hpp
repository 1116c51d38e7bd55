#pragma once

#include <optional>
#include <vector>

#include "pipeline/core/frame.hpp"
#include "pipeline/preprocess/settings.hpp"
#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab::commands {

/// What the readings of a recording are, to tell why nothing may have been found in them.
class Readings {
public:
    /// How far they are is counted for the smoothing alone: it takes its time in every frame.
    explicit Readings(std::optional<MovingLeastSquaresSettings> smoothing);

    void add(const RgbdFrame& frame);

    /// On stderr: that there are none, or that too many are too near to be smoothed.
    void warn(const SourceInfo& source) const;

private:
    void warn_of_smoothing(const RgbdCamera& camera) const;
    [[nodiscard]] std::size_t nearer_than(double counts) const;

    std::optional<MovingLeastSquaresSettings> smoothing_;
    bool any_ = false;
    std::vector<std::size_t> seen_;  ///< how many have these counts
};

}  // namespace kinectlab::commands
