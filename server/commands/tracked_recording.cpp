#include "server/commands/tracked_recording.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "pipeline/motion/motion.hpp"
#include "pipeline/run/chain.hpp"
#include "pipeline/sensor/recording.hpp"
#include "server/commands/progress.hpp"

namespace kinectlab::commands {
namespace {

constexpr std::chrono::milliseconds kPatience{5000};
constexpr TimeNs kReferenceTime = kNsPerSecond;
constexpr TimeNs kUncoverTime = 20 * kNsPerSecond;  // a bob at rest is moved aside well within it

template <class T>
tl::unexpected<Error> forward(const Result<T>& failed) {
    return tl::unexpected<Error>(failed.error());
}

// Positions are wrong by as much as the assumption is.
void warn_of_unknown_camera(const std::filesystem::path& path) {
    std::error_code code;
    if (!std::filesystem::is_directory(path, code) ||
        std::filesystem::exists(path / "camera.json", code))
        return;
    std::cerr << path.string()
              << ": has no camera.json; taken for a Kinect with "
                 "5000 depth counts a metre\n";
}

// The scene is what the first frames show, and what later ones show behind an object that was at
// rest there: its place may be hidden again in every frame that counts, as in a swing of a few
// degrees.
Result<void> learn(FrameSource& source, Chain& chain) {
    const std::size_t count = source.info().frame_count.value_or(0);
    const std::size_t most = std::max<std::size_t>(1, count / 4);
    RgbdFrame frame;
    TimeNs first = 0;
    for (std::size_t i = 0;; ++i) {
        const auto status = source.next(frame, kPatience);
        if (!status) return forward(status);
        if (*status != FrameStatus::frame) break;
        if (i == 0) first = frame.t;
        if (frame.t - first >= kUncoverTime) break;
        const bool early = i < most && frame.t - first < kReferenceTime;
        if (auto learned = early ? chain.learn(frame) : chain.uncover(frame); !learned)
            return learned;
    }
    if (chain.learned_frames() > 0) return {};
    return fail(
        ErrorCode::bad_data,
        source.info().name,
        "has no frames",
        "give a recording with at least one"
    );
}

// Frames that are missing between two times, at the nominal rate.
std::size_t lost_between(TimeNs earlier, TimeNs later, double rate_hz) {
    const double steps = to_seconds(later - earlier) * rate_hz;
    return steps > 1.5 ? static_cast<std::size_t>(std::llround(steps) - 1) : 0;
}

Result<void> track_all(FrameSource& source, Chain& chain, TrackedRecording& recording) {
    Progress progress("frames", source.info().frame_count.value_or(0));
    RgbdFrame frame;
    while (true) {
        const auto status = source.next(frame, kPatience);
        if (!status) return forward(status);
        if (*status != FrameStatus::frame) return {};
        const auto samples = chain.track(frame);
        if (!samples) return forward(samples);
        if (!recording.frames.empty())
            recording.frames_lost +=
                lost_between(recording.frames.back(), frame.t, source.info().frame_rate_hz);
        recording.frames.push_back(frame.t);
        for (const auto& sample : *samples)
            recording.samples[sample.object].push_back(sample);
        progress.step();
    }
}

MotionSample in_lab(const TrackSample& sample, const Eigen::Isometry3d& T_lab_cam) {
    static const Eigen::Vector3d kUnknown =
        Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    MotionSample moved;
    moved.t = sample.t;
    moved.status = sample.status;
    moved.p_lab = T_lab_cam * sample.p_cam;
    const Eigen::Matrix3d R = T_lab_cam.linear();
    moved.covariance.topLeftCorner<3, 3>() =
        R * sample.covariance.topLeftCorner<3, 3>() * R.transpose();
    moved.v_lab = moved.a_lab = moved.w_lab = kUnknown;
    moved.quality = sample.quality;
    return moved;
}

std::vector<Trajectory> ranked(
    const std::string& name,
    const std::vector<TrackSample>& samples,
    const Eigen::Isometry3d& T_lab_cam
) {
    std::vector<Trajectory> trajectories;
    std::size_t rank = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].status != TrackStatus::tracked) continue;
        rank = i > 0 && samples[i - 1].t == samples[i].t ? rank + 1 : 0;
        if (rank == trajectories.size())
            trajectories.push_back({name + "-" + std::to_string(rank + 1), {}});
        trajectories[rank].samples.push_back(in_lab(samples[i], T_lab_cam));
    }
    return trajectories;
}

}  // namespace

Result<TrackedRecording> track_recording(
    const std::filesystem::path& path, std::vector<ObjectSpec> objects
) {
    const RecordingOptions depth_alone{.with_colour = false};
    auto source = open_recording(path, depth_alone);
    if (!source) return forward(source);
    warn_of_unknown_camera(path);
    TrackedRecording recording;
    recording.source = (*source)->info();
    recording.objects = std::move(objects);
    recording.samples.resize(recording.objects.size());

    ChainSettings settings;
    settings.camera = recording.source.camera;
    settings.objects = recording.objects;
    auto chain = Chain::create(settings);
    if (!chain) return forward(chain);
    if (auto learned = learn(**source, *chain); !learned) return forward(learned);
    recording.learned_frames = chain->learned_frames();

    source->reset();  // an .oni file has one player, which must start anew
    auto again = open_recording(path, depth_alone);
    if (!again) return forward(again);
    if (auto tracked = track_all(**again, *chain, recording); !tracked) return forward(tracked);
    return recording;
}

Eigen::Isometry3d lab_pose_of(const SourceInfo& source) {
    if (source.T_lab_cam) return *source.T_lab_cam;
    Eigen::Isometry3d T_lab_cam = Eigen::Isometry3d::Identity();
    T_lab_cam.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    return T_lab_cam;
}

std::vector<Trajectory> trajectories_of(const TrackedRecording& recording) {
    const Eigen::Isometry3d T_lab_cam = lab_pose_of(recording.source);
    MotionSettings motion;
    motion.frame_period_s = 1.0 / recording.source.frame_rate_hz;
    std::vector<Trajectory> trajectories;
    for (std::size_t i = 0; i < recording.objects.size(); ++i) {
        const auto& object = recording.objects[i];
        const auto& samples = recording.samples[i];
        if (finds_many(object)) {
            for (auto& trajectory : ranked(object.name, samples, T_lab_cam))
                trajectories.push_back(std::move(trajectory));
        } else {
            trajectories.push_back(to_trajectory(object.name, samples, T_lab_cam, motion));
        }
    }
    return trajectories;
}

}  // namespace kinectlab::commands
