#include "server/live/channel.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "server/lab/utc.hpp"
#include "server/live/pose_json.hpp"

namespace kinectlab::live {

void Channel::broadcast_state(const char* type, const std::string& json) {
    ++seq_;
    if (viewers_.empty()) return;
    const auto message = std::make_shared<const std::string>(
        fmt::format(R"({{"type":"{0}","seq":{1},"{0}":{2}}})", type, seq_, json)
    );
    for (const auto& viewer : viewers_)
        viewer->push_state(message, seq_);
}

void Channel::rig_changed(const lab::RigStatus& rig, const Encoders& encoders) {
    rig_json_ = encoders.rig(rig);
    broadcast_state("rig", rig_json_);
}

void Channel::run_changed(const lab::Run& run, const Encoders& encoders) {
    if (!run_ || run_->id != run.id) trail_.clear();
    run_ = run;
    broadcast_state("run", encoders.run(run));
}

void Channel::pose_measured(const bus::PoseMeasured& pose, TimeNs now) {
    ++seq_;
    if (pose.run && pose.sample.status != TrackStatus::lost) {
        trail_.push_back(encode_trail_point(pose.object, pose.sample));
        if (trail_.size() > kTrailPoints) trail_.pop_front();
    }
    if (viewers_.empty()) return;
    const auto body = std::make_shared<const std::string>(encode_pose(pose, seq_));
    for (const auto& viewer : viewers_)
        viewer->push_pose(body, seq_, now);
}

void Channel::picture_taken(const std::shared_ptr<const std::string>& packet) {
    for (const auto& viewer : viewers_)
        viewer->push_picture(packet);
}

void Channel::add(
    const std::shared_ptr<Viewer>& viewer,
    const std::optional<lab::RigStatus>& rig_if_unknown,
    const Encoders& encoders,
    TimeNs now
) {
    if (rig_json_.empty() && rig_if_unknown) rig_json_ = encoders.rig(*rig_if_unknown);
    const bool under_way = run_ && !lab::is_final(run_->state);
    std::string hello = fmt::format(
        R"({{"type":"hello","seq":{},"server_time":"{}","rig":{},"run":{},"trail":[)",
        ++seq_,
        lab::to_rfc3339(now),
        rig_json_.empty() ? "null" : rig_json_,
        under_way ? encoders.run(*run_) : "null"
    );
    if (under_way) {
        for (const auto& point : trail_) {
            if (hello.back() != '[') hello += ',';
            hello += point;
        }
    }
    hello += "]}";
    viewer->push_state(std::make_shared<const std::string>(std::move(hello)), seq_);
    viewers_.push_back(viewer);
}

void Channel::remove(const std::shared_ptr<Viewer>& viewer) {
    std::erase(viewers_, viewer);
}

}  // namespace kinectlab::live
