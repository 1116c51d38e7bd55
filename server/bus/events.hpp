#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pipeline/core/trajectory.hpp"
#include "server/lab/rig.hpp"
#include "server/lab/run.hpp"

namespace kinectlab::bus {

struct RigChanged {
    lab::RigStatus rig;
};

/// The run's state changed, or its result is there.
struct RunChanged {
    lab::Run run;
};

/// One object in the newest frame.
struct PoseMeasured {
    std::string rig;
    std::optional<lab::RunId> run;  ///< set while the run measures
    std::string object;
    MotionSample sample;
    std::uint32_t missed = 0;  ///< frames that the device lost just before this one
};

/// The newest colour picture, at most ten a second.
struct PictureTaken {
    std::string rig;
    TimeNs t = 0;
    int width = 0;
    int height = 0;
    std::shared_ptr<const std::vector<std::uint8_t>> rgb;  ///< row-major, 3 bytes a pixel
};

using Event = std::variant<RigChanged, RunChanged, PoseMeasured, PictureTaken>;

/// The rig that an event is about.
[[nodiscard]] const std::string& rig_of(const Event& event);

}  // namespace kinectlab::bus
