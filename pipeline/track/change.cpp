#include "pipeline/track/change.hpp"

#include <cmath>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/identities.hpp"
#include "pipeline/track/thing_outlines.hpp"

namespace kinectlab {
namespace {

class ChangeTracker : public Tracker {
public:
    ChangeTracker(const RgbdCamera& camera, TrackedObjects<ChangeTrackSettings> objects) {
        for (auto& object : objects)
            followed_.push_back(
                {object.index, Identities(camera, object.settings.memory_s), ThingOutlines(camera)}
            );
    }

    void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) override {
        for (auto& [object, identities, outlines] : followed_) {
            const auto things = identities.follow(frame, moved);
            outlines.next_frame();
            for (std::size_t i = 0; i < things.size(); ++i) {
                TrackSample& sample = samples.emplace_back(sample_of(things[i], frame.t, object));
                if (things[i].seen)
                    sample.covariance.topLeftCorner<3, 3>() =
                        outlines.covariance(identities, i, things[i], frame, moved);
            }
        }
    }

    void reset() override {
        for (auto& followed : followed_) {
            followed.identities.reset();
            followed.outlines.reset();
        }
    }

private:
    struct Followed {
        std::uint32_t object;
        Identities identities;
        ThingOutlines outlines;
    };

    static TrackSample sample_of(const Thing& thing, TimeNs t, std::uint32_t object) {
        TrackSample sample;
        sample.t = t;
        sample.object = object;
        sample.identity = thing.identity;
        if (!thing.seen) return sample;
        sample.status = TrackStatus::tracked;
        sample.p_cam = thing.now.centroid();
        sample.quality = {thing.now.points, 1.0, 0.0};
        return sample;
    }

    std::vector<Followed> followed_;
};

}  // namespace

Result<void> check(const ChangeTrackSettings& settings, const std::string& path) {
    if (std::isfinite(settings.memory_s) && settings.memory_s >= 0.0 && settings.memory_s <= 60.0)
        return {};
    return fail(
        ErrorCode::invalid_argument,
        path + ".memory_s",
        "is " + number_text(settings.memory_s),
        "give seconds from 0 to 60, e.g. 2"
    );
}

std::unique_ptr<Tracker> make_change_tracker(
    const RgbdCamera& camera, TrackedObjects<ChangeTrackSettings> objects
) {
    return std::make_unique<ChangeTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
