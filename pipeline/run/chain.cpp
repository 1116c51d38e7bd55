#include "pipeline/run/chain.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/preprocess/change.hpp"
#include "pipeline/preprocess/change_limits.hpp"
#include "pipeline/preprocess/reference.hpp"
#include "pipeline/preprocess/segment.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {
namespace {

using Trackers = std::vector<std::unique_ptr<Tracker>>;

ChangeSettings change_settings(const RgbdCamera& camera) {
    ChangeSettings settings;
    settings.width = camera.depth.width;
    settings.height = camera.depth.height;
    settings.product = static_cast<float>(DisparityScale(camera).product);
    return settings;
}

Result<void> check(const ChainSettings& settings) {
    const auto& camera = settings.camera;
    if (camera.depth.width < 16 || camera.depth.height < 16)
        return fail(
            ErrorCode::invalid_argument,
            "camera",
            "is " + std::to_string(camera.depth.width) + "x" + std::to_string(camera.depth.height) +
                " pixels",
            "give the depth picture's size, at least 16x16"
        );
    for (const double value :
         {camera.depth.fx,
          camera.depth.fy,
          camera.depth_unit_m,
          camera.noise.inverse_depth_step,
          camera.noise.sigma_steps,
          settings.change_threshold_steps})
        if (!std::isfinite(value) || value <= 0.0)
            return fail(
                ErrorCode::invalid_argument,
                "camera",
                "a focal length, depth unit, noise or the change threshold is " +
                    std::to_string(value),
                "all of them are above 0"
            );
    return {};
}

}  // namespace

struct Chain::State {
    State(const ChainSettings& settings, Trackers made)
        : camera(settings.camera),
          reference(settings.camera),
          limits(settings.camera, settings.change_threshold_steps),
          change(change_settings(settings.camera)),
          segmenter(change, settings.min_segment_points),
          trackers(std::move(made)) {
        runs.reserve(most_runs(change));
        samples.reserve(
            settings.objects.size() * static_cast<std::size_t>(Segmenter::kMaxSegments)
        );
    }

    [[nodiscard]] Result<void> check_size(const RgbdFrame& frame) const {
        const int width = camera.depth.width, height = camera.depth.height;
        if (frame.depth.size() ==
            static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
            return {};
        return fail(
            ErrorCode::bad_data,
            "depth",
            "the frame has " + std::to_string(frame.depth.size()) + " pixels",
            "the camera has " + std::to_string(width) + "x" + std::to_string(height)
        );
    }

    RgbdCamera camera;
    ReferenceScene reference;
    ChangeLimits limits;
    bool limits_are_old = true;
    ChangeSettings change;
    Segmenter segmenter;
    Trackers trackers;
    std::vector<ChangedRun> runs;
    std::vector<TrackSample> samples;
};

Chain::Chain(std::unique_ptr<State> state) : state_(std::move(state)) {}
Chain::Chain(Chain&&) noexcept = default;
Chain& Chain::operator=(Chain&&) noexcept = default;
Chain::~Chain() = default;

Result<Chain> Chain::create(ChainSettings settings) {
    if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
    auto trackers = make_trackers(settings.camera, settings.objects);
    if (!trackers) return tl::unexpected(trackers.error());
    return Chain(std::make_unique<State>(settings, std::move(*trackers)));
}

Result<void> Chain::learn(const RgbdFrame& frame) {
    if (auto ok = state_->check_size(frame); !ok) return ok;
    state_->reference.learn(frame.depth);
    state_->limits_are_old = true;
    return {};
}

Result<void> Chain::uncover(const RgbdFrame& frame) {
    if (auto ok = state_->check_size(frame); !ok) return ok;
    state_->reference.uncover(frame.depth);
    state_->limits_are_old = true;
    return {};
}

Result<std::span<const TrackSample>> Chain::track(const RgbdFrame& frame) {
    State& s = *state_;
    if (auto ok = s.check_size(frame); !ok) return tl::unexpected(ok.error());
    if (s.reference.learned_frames() == 0)
        return fail(
            ErrorCode::conflict,
            "reference",
            "no frame of the scene was learned yet",
            "learn at least one frame before tracking"
        );
    if (s.limits_are_old) s.limits.rebuild(s.reference);
    s.limits_are_old = false;

    find_changed(frame.depth, s.limits.reach(), s.change, s.runs);
    const auto segments = s.segmenter.segment(frame.depth, s.limits.trusted(), s.runs);
    s.samples.clear();
    for (const auto& tracker : s.trackers)
        tracker->track(frame, segments, s.samples);
    std::sort(s.samples.begin(), s.samples.end(), [](const TrackSample& a, const TrackSample& b) {
        return a.object != b.object ? a.object < b.object : a.quality.points > b.quality.points;
    });

    const RowRange followed = s.reference.follow(frame.depth);
    s.limits.update(s.reference, followed);
    return std::span<const TrackSample>(s.samples);
}

void Chain::reset() {
    state_->reference.reset();
    state_->limits_are_old = true;
    for (const auto& tracker : state_->trackers)
        tracker->reset();
}

std::size_t Chain::learned_frames() const {
    return state_->reference.learned_frames();
}

}  // namespace kinectlab
