#include "pipeline/track/change.hpp"

#include <cmath>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/identities.hpp"

namespace kinectlab {
namespace {

class ChangeTracker : public Tracker {
public:
    ChangeTracker(const RgbdCamera& camera, TrackedObjects<ChangeTrackSettings> objects)
        : lens_(camera.depth) {
        for (auto& object : objects)
            followed_.push_back({object.index, Identities(camera, object.settings.memory_s)});
    }

    void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) override {
        for (auto& [object, identities] : followed_)
            for (const Thing& thing : identities.follow(frame, moved))
                samples.push_back(sample_of(thing, frame.t, object));
    }

    void reset() override {
        for (auto& [object, identities] : followed_)
            identities.reset();
    }

private:
    struct Followed {
        std::uint32_t object;
        Identities identities;
    };

    [[nodiscard]] TrackSample sample_of(const Thing& thing, TimeNs t, std::uint32_t object) const {
        TrackSample sample;
        sample.t = t;
        sample.object = object;
        sample.identity = thing.identity;
        if (!thing.seen) return sample;
        sample.status = TrackStatus::tracked;
        sample.p_cam = thing.now.centroid();
        auto covariance = sample.covariance.topLeftCorner<3, 3>();
        covariance = thing.now.centroid_covariance(lens_);
        covariance.diagonal().array() += thing.hidden_u * thing.hidden_u;
        sample.quality = {thing.now.points, 1.0, 0.0};
        return sample;
    }

    Pinhole lens_;
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
