#include "server/commands/tracked_recording.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <iostream>
#include <map>

#include "pipeline/motion/motion.hpp"
#include "pipeline/run/chain.hpp"
#include "pipeline/sensor/rewindable_recording.hpp"
#include "pipeline/sensor/tum_sequence.hpp"
#include "server/commands/progress.hpp"
#include "server/commands/readings.hpp"

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
    if (!std::filesystem::exists(path / "depth.txt", code) ||
        std::filesystem::exists(path / "camera.json", code))
        return;
    std::cerr << path.string()
              << ": has no camera.json; taken for a Kinect with "
                 "5000 depth counts a metre\n";
}

// Depth alone is sound and goes on; the damage is told, because a later run may want the colour.
void warn_of_damaged_colour(const DamagedPictures& found) {
    if (found.damaged == 0) return;
    std::cerr << "warning: " << to_text(*found.first) << " (" << found.damaged << " of "
              << found.all << " colour pictures; nothing that is tracked here needs them)\n";
}

// The scene is what the first frames show, and what later ones show behind an object that was at
// rest there: its place may be hidden again in every frame that counts, as in a swing of a few
// degrees. Another kind of reference takes its own time and nothing more.
Result<void> learn(FrameSource& source, Chain& chain, const ReferenceSettings& reference) {
    const bool scene = reference.method == ReferenceMethod::scene;
    const TimeNs time = scene ? kReferenceTime : from_seconds(reference.seconds);
    const TimeNs end = scene ? kUncoverTime : time;
    const std::size_t count = source.info().frame_count.value_or(0);
    const std::size_t most = std::max<std::size_t>(1, count / 4);
    const double frames = to_seconds(end) * source.info().frame_rate_hz;
    Progress progress("frames of the scene", std::min(count, static_cast<std::size_t>(frames)));
    RgbdFrame frame;
    TimeNs first = 0;
    for (std::size_t i = 0;; ++i) {
        const auto status = source.next(frame, kPatience);
        if (!status) return forward(status);
        if (*status != FrameStatus::frame) break;
        if (i == 0) first = frame.t;
        if (frame.t - first >= end) break;
        const bool early = i < most && frame.t - first < time;
        if (auto learned = early ? chain.learn(frame) : chain.uncover(frame); !learned)
            return learned;
        progress.step();
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

Result<void> track_all(
    FrameSource& source, Chain& chain, TrackedRecording& recording, Readings& readings
) {
    Progress progress("frames", source.info().frame_count.value_or(0));
    RgbdFrame frame;
    while (true) {
        const auto status = source.next(frame, kPatience);
        if (!status) return forward(status);
        if (*status != FrameStatus::frame) return {};
        readings.add(frame);
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

Result<TrackedRecording> go_through(RewindableRecording& source, TrackingPlan plan) {
    TrackedRecording recording;
    recording.source = source.info();
    recording.objects = std::move(plan.objects);
    recording.preprocess = plan.preprocess;
    recording.samples.resize(recording.objects.size());

    ChainSettings settings;
    settings.camera = recording.source.camera;
    settings.objects = recording.objects;
    settings.preprocess = recording.preprocess;
    auto chain = Chain::create(settings);
    if (!chain) return forward(chain);
    if (auto learned = learn(source, *chain, recording.preprocess.reference); !learned)
        return forward(learned);
    recording.learned_frames = chain->learned_frames();

    if (auto rewound = source.rewind(); !rewound) return forward(rewound);
    Readings readings(recording.preprocess.smoothing);
    if (auto tracked = track_all(source, *chain, recording, readings); !tracked)
        return forward(tracked);
    readings.warn(recording.source);
    return recording;
}

/// What one thing among many did, from when it was first to when it was last seen.
struct ThingSamples {
    std::uint32_t identity = 0;
    std::vector<TrackSample> samples;
};

std::vector<ThingSamples> by_identity(const std::vector<TrackSample>& samples) {
    std::map<std::uint32_t, std::vector<TrackSample>> of;
    for (const auto& sample : samples)
        of[sample.identity].push_back(sample);
    std::vector<ThingSamples> things;
    for (auto& [identity, own] : of) {
        while (!own.empty() && own.back().status != TrackStatus::tracked)
            own.pop_back();
        if (!own.empty()) things.push_back({identity, std::move(own)});
    }
    return things;
}

}  // namespace

Result<TrackedRecording> track_recording(const std::filesystem::path& path, TrackingPlan plan) {
    const bool with_colour = std::any_of(plan.objects.begin(), plan.objects.end(), needs_colour);
    auto source = RewindableRecording::open(path, {.with_colour = with_colour, .ahead = true});
    if (!source) return forward(source);
    warn_of_unknown_camera(path);
    std::error_code code;
    std::future<DamagedPictures> colour;  // found meanwhile: hundreds of megabytes are read for it
    if (!with_colour && std::filesystem::exists(path / "depth.txt", code))
        colour = std::async(std::launch::async, check_colour_pictures, path);
    auto recording = go_through(**source, std::move(plan));
    if (colour.valid()) warn_of_damaged_colour(colour.get());
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
            for (const auto& thing : by_identity(samples))
                trajectories.push_back(to_trajectory(
                    object.name + "-" + std::to_string(thing.identity),
                    thing.samples,
                    T_lab_cam,
                    motion
                ));
        } else {
            trajectories.push_back(to_trajectory(object.name, samples, T_lab_cam, motion));
        }
    }
    return trajectories;
}

}  // namespace kinectlab::commands
