#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/store/poses.hpp"

namespace kinectlab::rig {

/// Stores poses on a thread of its own, a batch at least every half second, so that no frame waits
/// for the disk and a crash costs less than a second. Never loses a pose: where the disk is too
/// slow for `limit` waiting poses, append() waits.
class PoseWriter {
public:
    explicit PoseWriter(store::PoseRepository& poses, std::size_t limit = 20'000);
    ~PoseWriter();  ///< stores what waits
    PoseWriter(const PoseWriter&) = delete;
    PoseWriter& operator=(const PoseWriter&) = delete;

    /// `so_far`: the run's frames with this one, stored together with its poses.
    void append(
        lab::RunId run, store::StoredPose pose, std::optional<store::FrameCounts> so_far = {}
    );

    /// Returns when everything appended so far is on the disk, or storing has failed.
    void flush();

    /// Why poses could not be stored, if that happened since the last call.
    [[nodiscard]] std::optional<std::string> take_error();

private:
    struct Waiting {
        lab::RunId run = 0;
        store::StoredPose pose;
        std::optional<store::FrameCounts> so_far;
    };

    void work();
    void store(const std::vector<Waiting>& batch);

    store::PoseRepository& poses_;
    const std::size_t limit_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Waiting> waiting_;
    bool storing_ = false;
    bool hurry_ = false;
    bool closing_ = false;
    std::optional<std::string> error_;
    std::thread thread_;
};

}  // namespace kinectlab::rig
