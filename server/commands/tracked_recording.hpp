#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/core/trajectory.hpp"
#include "pipeline/run/tracking_plan.hpp"
#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab::commands {

/// A whole recording, gone through by the chain.
struct TrackedRecording {
    SourceInfo source;
    std::vector<ObjectSpec> objects;
    PreprocessSettings preprocess;
    std::vector<TimeNs> frames;  ///< time of each
    /// For each object its samples in time order: one a frame, with method "change" as many as
    /// moved.
    std::vector<std::vector<TrackSample>> samples;
    std::size_t learned_frames = 0;  ///< that the reference scene rests on
    std::size_t frames_lost = 0;     ///< gaps in the times, in frames
};

/// Learns the reference scene from the first second of the recording, or from as many seconds as
/// its method asks for (of a short one from its first quarter, at least one frame), then tracks
/// from the first frame to the last.
[[nodiscard]] Result<TrackedRecording> track_recording(
    const std::filesystem::path& path, TrackingPlan plan
);

/// Where the camera stands; a recording that does not say is taken to come from a level camera at
/// the lab's origin that looks along y.
[[nodiscard]] Eigen::Isometry3d lab_pose_of(const SourceInfo& source);

/// One trajectory for each object, gaps filled and marked. With method "change" one for each thing
/// that moved, NAME-1, NAME-2, … in the order in which they came, from where it was first seen to
/// where it was last.
[[nodiscard]] std::vector<Trajectory> trajectories_of(const TrackedRecording& recording);

}  // namespace kinectlab::commands
