#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/live/hub.hpp"

namespace kinectlab::live {

/// The path that a late viewer is told: two minutes at 30 Hz.
constexpr std::size_t kTrailPoints = 3600;

/// One rig's viewers and what a new one has to know. Not thread-safe: the hub locks around it.
class Channel {
public:
    void rig_changed(const lab::RigStatus& rig, const Encoders& encoders);
    void run_changed(const lab::Run& run, const Encoders& encoders);
    void pose_measured(const bus::PoseMeasured& pose, TimeNs now);
    void picture_taken(const std::shared_ptr<const std::string>& packet);

    void add(
        const std::shared_ptr<Viewer>& viewer,
        const std::optional<lab::RigStatus>& rig_if_unknown,
        const Encoders& encoders,
        TimeNs now
    );
    void remove(const std::shared_ptr<Viewer>& viewer);
    [[nodiscard]] std::size_t viewers() const { return viewers_.size(); }

private:
    void broadcast_state(const char* type, const std::string& json);

    std::vector<std::shared_ptr<Viewer>> viewers_;
    std::uint64_t seq_ = 0;
    std::string rig_json_;
    std::optional<lab::Run> run_;
    std::deque<std::string> trail_;
};

}  // namespace kinectlab::live
