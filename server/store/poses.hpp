#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/trajectory.hpp"
#include "server/lab/run.hpp"
#include "server/store/database.hpp"

namespace kinectlab::store {

struct StoredPose {
    std::string object;
    MotionSample
        sample;  ///< acceleration, and what position and orientation have in common, are not stored
};

/// How many frames a measurement has seen and missed so far.
struct FrameCounts {
    std::int64_t frames = 0;
    std::int64_t lost = 0;
};

/// What was measured in a run, one row for each object and frame, so that a crash loses at most
/// what was not yet appended.
class PoseRepository {
public:
    explicit PoseRepository(Database& database) : database_(database) {}

    /// On the disk when it returns. Poses of an object must come in order of time. `so_far` goes to
    /// the run with them, so that after a crash its frames fit its poses; it never takes any back.
    void append(
        lab::RunId run,
        std::span<const StoredPose> poses,
        const std::optional<FrameCounts>& so_far = {}
    );
    /// Puts the final trajectories (gaps filled, velocities from both sides) in the place of what
    /// was measured live.
    void replace(lab::RunId run, std::span<const Trajectory> trajectories);
    /// In order of time.
    [[nodiscard]] std::vector<Trajectory> of_run(lab::RunId run);
    [[nodiscard]] std::size_t count(lab::RunId run);

private:
    Database& database_;
};

}  // namespace kinectlab::store
