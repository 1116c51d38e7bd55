#include "pipeline/track/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/track/sphere_candidate.hpp"
#include "pipeline/track/sphere_fit.hpp"

namespace kinectlab {
namespace {

// What is accepted as a sphere. Each bound was chosen so that a clean ball passes far from it.
constexpr double kMinSupport = 0.25;      // of a segment's points: a hand may hold the ball
constexpr double kMinInlierShare = 0.70;  // of the readings inside the outline
constexpr double kMinVisible = 0.45;      // of the pixels that it should cover
constexpr double kMinAlone = 0.50;        // of the pixels around: strings and magnets touch it
constexpr double kMaxRmsSigmas = 3.0;
constexpr double kMaxRadiusShareU = 0.15;  // a free radius less sure than this is no measurement

constexpr TimeNs kMemory = kNsPerSecond / 2;  // a place older than this says nothing
constexpr std::size_t kMostTries = 8;         // segments looked at for one object

class SphereTracker : public Tracker {
public:
    SphereTracker(const RgbdCamera& camera, TrackedObjects<SphereSettings> objects)
        : camera_(camera), scale_(camera), fitter_(camera) {
        for (auto& object : objects)
            targets_.push_back({std::move(object), {}, 0, false, {}});
        order_.resize(targets_.size());
        segments_.reserve(kMostTries);
        claimed_.reserve(targets_.size());
        rest_.reserve(static_cast<std::size_t>(camera.depth.width * camera.depth.height));
    }

    void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) override {
        // Those seen a moment ago choose first, so that a lost one cannot take their sphere.
        for (std::size_t i = 0; i < order_.size(); ++i)
            order_[i] = i;
        std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
            const bool fresh_a = is_fresh(targets_[a], frame.t),
                       fresh_b = is_fresh(targets_[b], frame.t);
            return fresh_a != fresh_b ? fresh_a : a < b;
        });
        claimed_.clear();
        for (const std::size_t i : order_)
            find(targets_[i], frame, moved);
        for (const auto& target : targets_)
            samples.push_back(target.sample);
    }

    void reset() override {
        for (auto& target : targets_)
            target.has_place = false;
    }

private:
    struct Target {
        TrackedObject<SphereSettings> object;
        Eigen::Vector3d place_cam = Eigen::Vector3d::Zero();
        TimeNs seen_at = 0;
        bool has_place = false;
        TrackSample sample;
    };

    static bool is_fresh(const Target& target, TimeNs t) {
        return target.has_place && t - target.seen_at <= kMemory;
    }

    void find(Target& target, const RgbdFrame& frame, std::span<const MovedPixels> moved) {
        target.sample = TrackSample{};
        target.sample.t = frame.t;
        target.sample.object = target.object.index;
        for (const auto& pixels : likely_segments(target, frame, moved)) {
            const auto fit = detect(target.object.settings, frame, pixels);
            if (!fit) continue;
            claimed_.push_back(fit->sphere);
            target.place_cam = fit->sphere.centre_cam;
            target.seen_at = frame.t;
            target.has_place = true;
            target.sample.status = TrackStatus::tracked;
            target.sample.p_cam = fit->sphere.centre_cam;
            target.sample.covariance.topLeftCorner<3, 3>() = fit->covariance;
            target.sample.quality = fit->quality;
            return;
        }
    }

    /// Nearest to the object's last place first; biggest first where there is none.
    std::span<const MovedPixels> likely_segments(
        const Target& target, const RgbdFrame& frame, std::span<const MovedPixels> moved
    ) {
        segments_.assign(
            moved.begin(),
            moved.begin() + static_cast<std::ptrdiff_t>(std::min(kMostTries, moved.size()))
        );
        if (!is_fresh(target, frame.t)) return segments_;
        std::sort(segments_.begin(), segments_.end(), [&](MovedPixels a, MovedPixels b) {
            return distance(target, frame, a) < distance(target, frame, b);
        });
        return segments_;
    }

    double distance(const Target& target, const RgbdFrame& frame, MovedPixels pixels) const {
        double nearest = std::numeric_limits<double>::max();
        const std::size_t step = std::max<std::size_t>(1, pixels.size() / 16);
        for (std::size_t k = 0; k < pixels.size(); k += step)
            nearest = std::min(nearest, (point(frame, pixels[k]) - target.place_cam).norm());
        return nearest;
    }

    [[nodiscard]] Eigen::Vector3d point(const RgbdFrame& frame, std::uint32_t pixel) const {
        const auto column = static_cast<int>(pixel) % camera_.depth.width;
        const auto row = static_cast<int>(pixel) / camera_.depth.width;
        return camera_.depth.ray(column, row) * (camera_.depth_unit_m * frame.depth[pixel]);
    }

    std::optional<SphereFit> detect(
        const SphereSettings& settings, const RgbdFrame& frame, MovedPixels pixels
    ) {
        const MovedPixels free = without_claimed(frame, pixels);
        const SurfaceSample sample(frame.depth, free, camera_.depth, scale_);
        const auto candidate = sphere_candidate(sample.points(), settings, scale_);
        if (!candidate || support(*candidate, sample.points(), scale_) < kMinSupport)
            return std::nullopt;
        auto fit = fitter_.fit(frame.depth, *candidate, settings.radius_m.has_value());
        return fit && is_sphere(*fit, settings) ? fit : std::nullopt;
    }

    /// The pixels that no other object's sphere explains already.
    MovedPixels without_claimed(const RgbdFrame& frame, MovedPixels pixels) {
        if (claimed_.empty()) return pixels;
        rest_.clear();
        for (const auto pixel : pixels) {
            const Eigen::Vector3d p_cam = point(frame, pixel);
            const bool taken = std::any_of(claimed_.begin(), claimed_.end(), [&](const Sphere& s) {
                return (p_cam - s.centre_cam).norm() < 1.2 * s.radius;
            });
            if (!taken) rest_.push_back(pixel);
        }
        return rest_;
    }

    [[nodiscard]] bool is_sphere(const SphereFit& fit, const SphereSettings& settings) const {
        const double z = fit.sphere.centre_cam.z();
        const bool radius_fits =
            settings.radius_m || (fit.sphere.radius >= settings.min_radius_m &&
                                  fit.sphere.radius <= settings.max_radius_m &&
                                  fit.radius_u <= kMaxRadiusShareU * fit.sphere.radius);
        return radius_fits && fit.quality.inlier_share >= kMinInlierShare &&
               fit.visible_share >= kMinVisible && fit.alone_share >= kMinAlone &&
               fit.quality.rms_steps <= kMaxRmsSigmas * scale_.sigma_at(scale_.steps_at(z));
    }

    RgbdCamera camera_;
    DisparityScale scale_;
    SphereFitter fitter_;
    std::vector<Target> targets_;
    std::vector<std::size_t> order_;
    std::vector<Sphere> claimed_;
    std::vector<MovedPixels> segments_;
    std::vector<std::uint32_t> rest_;
};

Result<void> check_radius(const std::string& field, double radius_m) {
    if (std::isfinite(radius_m) && radius_m > 0.0 && radius_m <= 2.0) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is " + std::to_string(radius_m),
        "give a radius in metres above 0 and up to 2, e.g. 0.05"
    );
}

}  // namespace

Result<void> check(const SphereSettings& settings, const std::string& path) {
    if (settings.radius_m) return check_radius(path + ".radius_m", *settings.radius_m);
    if (auto ok = check_radius(path + ".min_radius_m", settings.min_radius_m); !ok) return ok;
    if (auto ok = check_radius(path + ".max_radius_m", settings.max_radius_m); !ok) return ok;
    if (settings.min_radius_m < settings.max_radius_m) return {};
    return fail(
        ErrorCode::invalid_argument,
        path + ".min_radius_m",
        "is " + std::to_string(settings.min_radius_m) + ", not below max_radius_m " +
            std::to_string(settings.max_radius_m),
        "give a range, or radius_m alone"
    );
}

std::unique_ptr<Tracker> make_sphere_tracker(
    const RgbdCamera& camera, TrackedObjects<SphereSettings> objects
) {
    return std::make_unique<SphereTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
