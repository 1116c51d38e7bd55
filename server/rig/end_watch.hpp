#pragma once

#include <map>
#include <optional>
#include <string>

#include "pipeline/core/trajectory.hpp"
#include "server/experiments/definition.hpp"

namespace kinectlab::rig {

/// Notices that a run is over before its time, as its definition says: everything is gone from the
/// picture, or nothing moves any more.
class EndWatch {
public:
    explicit EndWatch(const experiments::EarlyEnd& rules) : rules_(rules) {}

    /// One object's newest sample; `object` tells them apart.
    void look(const std::string& object, const MotionSample& sample);

    /// Why the run is over at `t`, for people; nothing while it goes on.
    [[nodiscard]] std::optional<std::string> over(TimeNs t) const;

private:
    struct Object {
        TimeNs seen = 0;
        TimeNs still_since = 0;
        Eigen::Vector3d still_at = Eigen::Vector3d::Zero();
    };

    experiments::EarlyEnd rules_;
    std::map<std::string, Object> objects_;
};

}  // namespace kinectlab::rig
