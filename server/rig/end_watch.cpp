#include "server/rig/end_watch.hpp"

#include <algorithm>

namespace kinectlab::rig {
namespace {

constexpr double kStill = 0.005;  // m: what the noise of a Kinect at 2 m may move it

}  // namespace

void EndWatch::look(const std::string& object, const MotionSample& sample) {
    if (sample.status != TrackStatus::tracked) return;
    const auto [found, first] = objects_.try_emplace(object);
    Object& o = found->second;
    o.seen = sample.t;
    if (!first && (sample.p_lab - o.still_at).norm() <= kStill) return;
    o.still_since = sample.t;
    o.still_at = sample.p_lab;
}

std::optional<std::string> EndWatch::over(TimeNs t) const {
    if (objects_.empty()) return std::nullopt;
    const auto all = [&](auto&& holds) {
        return std::all_of(objects_.begin(), objects_.end(), [&](const auto& entry) {
            return holds(entry.second);
        });
    };
    if (rules_.lost_s &&
        all([&](const Object& o) { return t - o.seen >= from_seconds(*rules_.lost_s); }))
        return "Nothing is in view any more";
    if (rules_.still_s &&
        all([&](const Object& o) { return t - o.still_since >= from_seconds(*rules_.still_s); }))
        return "Nothing moves any more";
    return std::nullopt;
}

}  // namespace kinectlab::rig
