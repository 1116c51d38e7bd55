#include "server/live/viewer.hpp"

#include <utility>

#include "server/live/pose_json.hpp"

namespace kinectlab::live {

void Viewer::push_state(Shared message, std::uint64_t seq) {
    const std::lock_guard lock(mutex_);
    states_.push_back({std::move(message), seq});
    if (states_.size() > kStates) states_.pop_front();
    if (wake_) wake_();
}

void Viewer::give_up_oldest_pose() {
    poses_.pop_front();
    ++missed_since_;
    ++missed_;
}

void Viewer::push_pose(Shared body, std::uint64_t seq, TimeNs now) {
    const std::lock_guard lock(mutex_);
    poses_.push_back({std::move(body), seq, now});
    // Without room in the window only the newest is worth keeping.
    const std::size_t room = window_open() ? kWindow - unanswered_.size() : 1;
    while (poses_.size() > room)
        give_up_oldest_pose();
    if (wake_) wake_();
}

void Viewer::push_picture(Shared packet) {
    const std::lock_guard lock(mutex_);
    picture_ = std::move(packet);
    if (wake_) wake_();
}

bool Viewer::window_open() const {
    return unanswered_.size() < kWindow;
}

bool Viewer::pose_is_next() const {
    if (poses_.empty()) return false;
    const Pose& pose = poses_.front();
    if (!states_.empty() && states_.front().seq < pose.seq) return false;
    return window_open() || pose.pushed >= last_sent_ + kTrickle;
}

Outgoing Viewer::take_pose() {
    Pose pose = std::move(poses_.front());
    poses_.pop_front();
    if (!window_open()) unanswered_.pop_front();
    unanswered_.push_back(pose.seq);
    last_sent_ = pose.pushed;
    return {std::move(pose.body), missed_tail(std::exchange(missed_since_, 0)), false};
}

Outgoing Viewer::take_state() {
    State state = std::move(states_.front());
    states_.pop_front();
    while (!poses_.empty() && poses_.front().seq < state.seq)
        give_up_oldest_pose();
    return {std::move(state.message), {}, false};
}

std::optional<Outgoing> Viewer::next() {
    const std::lock_guard lock(mutex_);
    if (pose_is_next()) return take_pose();
    if (!states_.empty()) return take_state();
    if (picture_ && window_open()) return Outgoing{std::exchange(picture_, nullptr), {}, true};
    return std::nullopt;
}

void Viewer::acknowledge(std::uint64_t seq) {
    const std::lock_guard lock(mutex_);
    while (!unanswered_.empty() && unanswered_.front() <= seq)
        unanswered_.pop_front();
}

void Viewer::on_wake(std::function<void()> wake) {
    const std::lock_guard lock(mutex_);
    wake_ = std::move(wake);
}

std::uint64_t Viewer::missed() const {
    const std::lock_guard lock(mutex_);
    return missed_;
}

}  // namespace kinectlab::live
