#include "server/live/viewer.hpp"

#include "server/live/pose_json.hpp"

namespace kinectlab::live {

void Viewer::push_state(Shared message) {
    const std::lock_guard lock(mutex_);
    states_.push_back(std::move(message));
    if (states_.size() > kStates) states_.pop_front();
    if (wake_) wake_();
}

void Viewer::push_pose(Shared body, std::uint64_t seq, TimeNs now) {
    const std::lock_guard lock(mutex_);
    poses_.push_back({std::move(body), seq, now});
    // Without room in the window only the newest is worth keeping.
    const std::size_t room = unanswered_.size() < kWindow ? kWindow - unanswered_.size() : 1;
    while (poses_.size() > room) {
        poses_.pop_front();
        ++missed_since_;
        ++missed_;
    }
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

std::optional<Outgoing> Viewer::next() {
    const std::lock_guard lock(mutex_);
    if (!states_.empty()) {
        Outgoing out{std::move(states_.front()), {}, false};
        states_.pop_front();
        return out;
    }
    if (!poses_.empty()) {
        const bool trickle = poses_.front().pushed >= last_sent_ + kTrickle;
        if (window_open() || trickle) {
            Pose pose = std::move(poses_.front());
            poses_.pop_front();
            if (!window_open()) unanswered_.pop_front();
            unanswered_.push_back(pose.seq);
            last_sent_ = pose.pushed;
            Outgoing out{std::move(pose.body), missed_tail(missed_since_), false};
            missed_since_ = 0;
            return out;
        }
    }
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
