#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/core/trajectory.hpp"
#include "pipeline/run/chain.hpp"
#include "pipeline/run/tracking_plan.hpp"
#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab::rig {

/// One object in one frame, as measured and as people are shown it.
struct Observed {
    std::string object;
    TrackSample track;    ///< camera frame
    MotionSample motion;  ///< lab frame; velocity from this frame and those just before
};

/// Where the camera stands if the source does not know: level, looking along the lab's y axis.
[[nodiscard]] Eigen::Isometry3d level_camera();

/// Watches the scene of one rig: the chain, and the short memory that velocities need.
/// Not thread-safe: the rig's worker owns it.
class Observer {
public:
    /// Errors as Chain::create.
    [[nodiscard]] static Result<Observer> create(
        const SourceInfo& source, const TrackingPlan& plan
    );

    [[nodiscard]] Result<void> learn(const RgbdFrame& frame) { return chain_.learn(frame); }
    [[nodiscard]] std::size_t learned_frames() const { return chain_.learned_frames(); }

    /// One entry for each object; for one that is many things (method "change") one for each of
    /// them, named NAME-1, NAME-2, …. The span is valid until the next call.
    [[nodiscard]] Result<std::span<const Observed>> track(const RgbdFrame& frame);

private:
    Observer(Chain chain, std::vector<ObjectSpec> objects, const SourceInfo& source);

    Chain chain_;
    std::vector<ObjectSpec> objects_;
    Eigen::Isometry3d T_lab_cam_;
    double frame_period_s_;
    /// For each object and each of the things that go by its name.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::deque<TrackSample>> recent_;
    std::vector<Observed> observed_;
};

}  // namespace kinectlab::rig
