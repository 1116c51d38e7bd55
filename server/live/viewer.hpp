#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "pipeline/core/time.hpp"

namespace kinectlab::live {

/// A message encoded once and shared by all viewers; `tail` is this viewer's own.
struct Outgoing {
    std::shared_ptr<const std::string> shared;
    std::string tail;
    bool binary = false;
};

/// What waits for one viewer. Poses and pictures are bounded: the newest wins and the poses that
/// made room are counted. A queue alone does not keep a slow viewer current, because the kernel's
/// buffers hold the backlog; so at most kWindow poses go out without an acknowledgement, then one a
/// second until it comes. Changes of state go first to last, each of them; sequence numbers grow.
/// Thread-safe.
class Viewer {
public:
    static constexpr std::size_t kWindow = 8;
    static constexpr std::size_t kStates = 64;
    static constexpr TimeNs kTrickle = kNsPerSecond;

    using Shared = std::shared_ptr<const std::string>;

    /// Hello, rig and run messages. Beyond kStates the oldest makes room: each of them is complete.
    void push_state(Shared message, std::uint64_t seq);
    /// `body` is what encode_pose gives.
    void push_pose(Shared body, std::uint64_t seq, TimeNs now);
    void push_picture(Shared packet);

    /// States and poses in their order, then pictures: a picture never delays a pose that is there.
    /// A state does not wait for a closed window; the poses before it are given up then.
    [[nodiscard]] std::optional<Outgoing> next();

    /// Everything up to `seq` was handled.
    void acknowledge(std::uint64_t seq);

    /// Called after each push, under the viewer's lock; an empty function ends it.
    void on_wake(std::function<void()> wake);

    /// Poses this viewer did not get.
    [[nodiscard]] std::uint64_t missed() const;

private:
    struct Pose {
        Shared body;
        std::uint64_t seq = 0;
        TimeNs pushed = 0;
    };
    struct State {
        Shared message;
        std::uint64_t seq = 0;
    };
    [[nodiscard]] bool window_open() const;
    [[nodiscard]] bool pose_is_next() const;
    Outgoing take_pose();
    Outgoing take_state();
    void give_up_oldest_pose();

    mutable std::mutex mutex_;
    std::function<void()> wake_;
    std::deque<State> states_;
    std::deque<Pose> poses_;
    Shared picture_;
    std::deque<std::uint64_t> unanswered_;
    TimeNs last_sent_ = 0;
    std::uint64_t missed_since_ = 0;
    std::uint64_t missed_ = 0;
};

}  // namespace kinectlab::live
