#include "pipeline/run/chain.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/core/number_text.hpp"
#include "pipeline/preprocess/preprocessing.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {
namespace {

using Trackers = std::vector<std::unique_ptr<Tracker>>;

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
          camera.noise.sigma_steps})
        if (!std::isfinite(value) || value <= 0.0)
            return fail(
                ErrorCode::invalid_argument,
                "camera",
                "a focal length, depth unit or noise is " + number_text(value),
                "all of them are above 0"
            );
    return check(settings.preprocess);
}

}  // namespace

struct Chain::State {
    State(const ChainSettings& settings, Trackers made)
        : camera(settings.camera),
          preprocessing(settings.camera, settings.preprocess),
          trackers(std::move(made)) {
        for (const auto& object : settings.objects)
            if (kinectlab::needs_colour(object)) needs_colour = object.name;
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

    /// A picture that is missing now and then makes its objects lost; one that never came will not.
    [[nodiscard]] Result<void> check_colour(const RgbdFrame& frame) {
        const auto size = 3 * static_cast<std::size_t>(camera.colour.width) *
                          static_cast<std::size_t>(camera.colour.height);
        if (needs_colour.empty() || frame.rgb.size() == size) {
            had_colour = true;
            return {};
        }
        if (had_colour && frame.rgb.empty()) return {};
        return fail(
            ErrorCode::bad_data,
            "rgb",
            frame.rgb.empty()
                ? "there is no colour, without which \"" + needs_colour + "\" cannot be tracked"
                : "the colour picture has " + std::to_string(frame.rgb.size()) + " bytes",
            frame.rgb.empty() ? "give a recording or a camera with colour, or another method"
                              : "the camera has " + std::to_string(camera.colour.width) + "x" +
                                    std::to_string(camera.colour.height) + " pixels of 3 bytes"
        );
    }

    RgbdCamera camera;
    Preprocessing preprocessing;
    std::string needs_colour;  // name of an object that does; empty if none
    bool had_colour = false;
    Trackers trackers;
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
    state_->preprocessing.learn(frame);
    return {};
}

Result<void> Chain::uncover(const RgbdFrame& frame) {
    if (auto ok = state_->check_size(frame); !ok) return ok;
    state_->preprocessing.uncover(frame);
    return {};
}

Result<std::span<const TrackSample>> Chain::track(const RgbdFrame& frame) {
    State& s = *state_;
    if (auto ok = s.check_size(frame); !ok) return tl::unexpected(ok.error());
    if (auto ok = s.check_colour(frame); !ok) return tl::unexpected(ok.error());
    if (s.preprocessing.learned_frames() == 0)
        return fail(
            ErrorCode::conflict,
            "reference",
            "no frame of the scene was learned yet",
            "learn at least one frame before tracking"
        );
    const auto clean = s.preprocessing.clean(frame);
    if (!clean) return tl::unexpected(clean.error());
    const auto moved = s.preprocessing.moved(**clean);
    if (!moved) return tl::unexpected(moved.error());
    s.samples.clear();
    for (const auto& tracker : s.trackers) {
        tracker->track(**clean, *moved, s.samples);
        if (auto fault = tracker->take_fault()) return tl::unexpected(std::move(*fault));
    }
    std::sort(s.samples.begin(), s.samples.end(), [](const TrackSample& a, const TrackSample& b) {
        if (a.object != b.object) return a.object < b.object;
        if (a.quality.points != b.quality.points) return a.quality.points > b.quality.points;
        return a.identity < b.identity;
    });

    s.preprocessing.follow(frame);
    return std::span<const TrackSample>(s.samples);
}

void Chain::reset() {
    state_->preprocessing.reset();
    for (const auto& tracker : state_->trackers)
        tracker->reset();
}

std::size_t Chain::learned_frames() const {
    return state_->preprocessing.learned_frames();
}

}  // namespace kinectlab
