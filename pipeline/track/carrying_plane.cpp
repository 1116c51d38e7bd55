#include "pipeline/track/carrying_plane.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/core/nearest_name.hpp"
#include "pipeline/track/plane_region.hpp"
#include "pipeline/track/touched_plane.hpp"

namespace kinectlab {
namespace {

constexpr std::string_view kNeverTouched = "the ball has not touched a plane in view yet";
constexpr std::string_view kHidden = "too little of the plane is in view";

class CarryingPlaneTracker : public Tracker {
public:
    CarryingPlaneTracker(const RgbdCamera& camera, std::span<const ObjectSpec> objects)
        : image_(camera), touched_(camera), other_(camera) {
        for (std::size_t i = 0; i < objects.size(); ++i) {
            if (!is_carrying(objects[i])) continue;
            const std::string& under = std::get<PlaneSettings>(objects[i].settings).under;
            const auto ball = std::find_if(objects.begin(), objects.end(), [&](const auto& other) {
                return other.name == under;
            });
            planes_.push_back(
                {static_cast<std::uint32_t>(i),
                 static_cast<std::uint32_t>(ball - objects.begin()),
                 std::get<SphereSettings>(ball->settings).radius_m,
                 PlaneRegion(camera)}
            );
        }
    }

    void track(
        const RgbdFrame& frame, std::span<const MovedPixels>, std::vector<TrackSample>& samples
    ) override {
        image_.load(frame.depth);
        for (Plane& plane : planes_) {
            const auto ball = seen_ball(plane, samples);
            TrackSample sample;
            sample.t = frame.t;
            sample.object = plane.index;
            if (const auto fit = find(plane, ball))
                take(*fit, sample);
            else
                sample.quality.why_lost = plane.region.is_grown() ? kHidden : kNeverTouched;
            samples.push_back(sample);
        }
    }

    void reset() override {
        for (Plane& plane : planes_)
            plane.region.forget();
    }

private:
    struct Plane {
        std::uint32_t index = 0;
        std::uint32_t ball = 0;  ///< index of the one that it carries
        std::optional<double> radius_m;
        PlaneRegion region;
    };

    static std::optional<SeenBall> seen_ball(
        const Plane& plane, const std::vector<TrackSample>& samples
    ) {
        for (const TrackSample& sample : samples) {
            if (sample.object != plane.ball || sample.status != TrackStatus::tracked) continue;
            return SeenBall{sample.p_cam, plane.radius_m.value_or(sample.size.radius_m)};
        }
        return std::nullopt;
    }

    std::optional<ShapeFit> find(Plane& plane, const std::optional<SeenBall>& ball) {
        const auto fit = plane.region.follow(image_);
        if (!ball || !std::isfinite(ball->radius_m) || (fit && touches(*ball, fit->shape)))
            return fit;
        const auto rough = touched_.find(image_, *ball);
        if (!rough) return fit;
        const auto grown = other_.grow(image_, *rough, touched_.pixels());
        if (!grown || !touches(*ball, grown->shape)) return fit;
        std::swap(plane.region, other_);
        return grown;
    }

    static void take(const ShapeFit& fit, TrackSample& sample) {
        sample.status = TrackStatus::tracked;
        sample.p_cam = fit.shape.point;
        sample.covariance = fit.covariance;
        sample.quality = fit.quality;
        sample.q_cam_obj = attitude_about(fit.shape.axis, Eigen::Vector3d::UnitX());
        sample.has_orientation = true;
    }

    DisparityImage image_;
    TouchedPlane touched_;
    PlaneRegion other_;  // that may take the place of one that is followed
    std::vector<Plane> planes_;
};

}  // namespace

std::unique_ptr<Tracker> make_carrying_plane_tracker(
    const RgbdCamera& camera, std::span<const ObjectSpec> objects
) {
    return std::make_unique<CarryingPlaneTracker>(camera, objects);
}

Result<void> check_carrying_planes(std::span<const ObjectSpec> objects) {
    std::vector<std::string> balls;
    for (const auto& object : objects)
        if (std::holds_alternative<SphereSettings>(object.settings)) balls.push_back(object.name);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (!is_carrying(objects[i])) continue;
        const std::string& under = std::get<PlaneSettings>(objects[i].settings).under;
        if (std::find(balls.begin(), balls.end(), under) != balls.end()) continue;
        return fail(
            ErrorCode::invalid_argument,
            "objects[" + std::to_string(i) + "].under",
            "is \"" + under.substr(0, 60) + "\", which is no ball of this list",
            balls.empty() ? "track the ball too, by the method sphere" : did_you_mean(under, balls)
        );
    }
    return {};
}

}  // namespace kinectlab
