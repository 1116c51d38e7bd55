#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/lab/run.hpp"

namespace kinectlab::lab {

enum class RigState : std::uint8_t {
    idle,     ///< frames arrive, no run
    busy,     ///< a run is under way
    offline,  ///< no device, or no frames; tried again every few seconds
};

[[nodiscard]] std::string_view to_text(RigState state);

/// What everybody may know about a rig.
struct RigStatus {
    std::string id;
    std::string name;
    RigState state = RigState::offline;
    std::string sentence;  ///< for people: "Free", "Measuring", "Offline: no device …"
    bool simulated = false;
    std::vector<std::string> experiments;
    double frame_rate_hz = 0.0;    ///< measured over the last seconds
    std::int64_t frames_lost = 0;  ///< since the server started
    std::optional<RunId> current_run;
};

}  // namespace kinectlab::lab
