#include "pipeline/track/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/assignment.hpp"
#include "pipeline/track/predicted_point.hpp"
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

constexpr TimeNs kMemory = kNsPerSecond / 2;  // a place older than this is no place to look first
constexpr std::size_t kMostTries = 8;         // segments looked at for one object

// Which of several balls of one size is which: -2 log likelihoods.
constexpr TimeNs kNameMemory = 2 * kNsPerSecond;  // hidden for so long a ball keeps its name
constexpr double kGate = 16.0;                    // 4 σ
constexpr double kAnywhere = 50.0;                // a ball that was not seen for long, or never
constexpr double kNoBall = 80.0;                  // dearer than any ball within the gate
constexpr double kUnitSpread = 0.01;              // m, of the likelihood
constexpr double kMostSpread = 0.4;               // m
constexpr double kLeastSpread = 2e-3;             // m
constexpr double kSurpriseRadii = 0.5;            // balls that bounce off each other

class SphereTracker : public Tracker {
public:
    SphereTracker(const RgbdCamera& camera, TrackedObjects<SphereSettings> objects)
        : camera_(camera),
          scale_(camera),
          fitter_(camera),
          assignment_(objects.size(), objects.size()) {
        for (auto& object : objects)
            targets_.push_back({std::move(object), {}, false, false, {}});
        order_.resize(targets_.size());
        for (auto* list : {&alike_, &order_})
            list->reserve(targets_.size());
        segments_.reserve(std::max(kMostTries, 2 * targets_.size()));
        claimed_.reserve(targets_.size());
        fits_.reserve(targets_.size());
        cost_.reserve(targets_.size() * targets_.size());
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
        for (auto& target : targets_) {
            target.done = false;
            target.sample = TrackSample{};
            target.sample.t = frame.t;
            target.sample.object = target.object.index;
        }
        for (const std::size_t i : order_)
            if (!targets_[i].done) find_alike(i, frame, moved);
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
        PredictedPoint place;
        bool has_place = false;
        bool done = false;  // in this frame
        TrackSample sample;
    };

    static bool is_fresh(const Target& target, TimeNs t, TimeNs memory = kMemory) {
        return target.has_place && t - target.place.seen_at() <= memory;
    }

    /// All objects that cannot be told apart by their size are looked for together.
    void find_alike(std::size_t first, const RgbdFrame& frame, std::span<const MovedPixels> moved) {
        const SphereSettings& settings = targets_[first].object.settings;
        alike_.clear();
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            const SphereSettings& other = targets_[i].object.settings;
            if (other.radius_m != settings.radius_m) continue;
            if (other.min_radius_m != settings.min_radius_m && !settings.radius_m) continue;
            if (other.max_radius_m != settings.max_radius_m && !settings.radius_m) continue;
            alike_.push_back(i);
            targets_[i].done = true;
        }
        fits_.clear();
        for (const auto& pixels : likely_segments(frame, moved)) {
            // Balls that touch are one segment.
            while (fits_.size() < alike_.size()) {
                auto fit = detect(settings, frame, pixels);
                if (!fit) break;
                claimed_.push_back(fit->sphere);
                fits_.push_back(std::move(*fit));
            }
            if (fits_.size() == alike_.size()) break;
        }
        name_fits(frame.t);
    }

    /// Gives each ball to the object that was most likely to be there; a single object takes its
    /// ball wherever it is.
    void name_fits(TimeNs t) {
        if (alike_.size() == 1) {
            if (!fits_.empty()) take(targets_[alike_.front()], fits_.front(), t);
            return;
        }
        cost_.clear();
        for (const std::size_t i : alike_)
            for (const auto& fit : fits_)
                cost_.push_back(cost_of(targets_[i], fit, t));
        const auto fit_of = assignment_.solve(cost_, alike_.size(), fits_.size(), kNoBall);
        for (std::size_t k = 0; k < alike_.size(); ++k)
            if (fit_of[k] != Assignment::kNone)
                take(targets_[alike_[k]], fits_[static_cast<std::size_t>(fit_of[k])], t);
    }

    static double cost_of(const Target& target, const SphereFit& fit, TimeNs t) {
        if (!is_fresh(target, t, kNameMemory)) return kAnywhere;
        const double surprise = kSurpriseRadii * fit.sphere.radius;
        const double variance =
            std::min(target.place.variance_at(t) + surprise * surprise, kMostSpread * kMostSpread);
        const double far = (fit.sphere.centre_cam - target.place.at(t)).squaredNorm() / variance;
        if (far > kGate) return kNoBall;
        return far + 3.0 * std::log(1.0 + variance / (kUnitSpread * kUnitSpread));
    }

    static void take(Target& target, const SphereFit& fit, TimeNs t) {
        const double variance = kLeastSpread * kLeastSpread + fit.covariance.trace() / 3.0;
        if (is_fresh(target, t, kNameMemory)) {
            target.place.observe(t, fit.sphere.centre_cam, variance);
        } else {
            target.place = PredictedPoint(t, fit.sphere.centre_cam, variance);
        }
        target.has_place = true;
        target.sample.status = TrackStatus::tracked;
        target.sample.p_cam = fit.sphere.centre_cam;
        target.sample.covariance.topLeftCorner<3, 3>() = fit.covariance;
        target.sample.quality = fit.quality;
        if (!target.object.settings.radius_m) {
            target.sample.size.radius_m = fit.sphere.radius;
            target.sample.size.radius_u = fit.radius_u;
        }
    }

    /// Nearest to where one of them should be first; biggest first where nobody knows.
    std::span<const MovedPixels> likely_segments(
        const RgbdFrame& frame, std::span<const MovedPixels> moved
    ) {
        const std::size_t tries = std::max(kMostTries, 2 * alike_.size());
        segments_.assign(
            moved.begin(),
            moved.begin() + static_cast<std::ptrdiff_t>(std::min(tries, moved.size()))
        );
        const bool any_fresh = std::any_of(alike_.begin(), alike_.end(), [&](std::size_t i) {
            return is_fresh(targets_[i], frame.t);
        });
        if (!any_fresh) return segments_;
        std::sort(segments_.begin(), segments_.end(), [&](MovedPixels a, MovedPixels b) {
            return distance(frame, a) < distance(frame, b);
        });
        return segments_;
    }

    [[nodiscard]] double distance(const RgbdFrame& frame, MovedPixels pixels) const {
        double nearest = std::numeric_limits<double>::max();
        const std::size_t step = std::max<std::size_t>(1, pixels.size() / 16);
        for (const std::size_t i : alike_) {
            if (!is_fresh(targets_[i], frame.t)) continue;
            const Eigen::Vector3d expected = targets_[i].place.at(frame.t);
            for (std::size_t k = 0; k < pixels.size(); k += step)
                nearest = std::min(nearest, (point(frame, pixels[k]) - expected).norm());
        }
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
    std::vector<std::size_t> order_, alike_;
    std::vector<SphereFit> fits_;  // of the objects alike
    std::vector<double> cost_;
    Assignment assignment_;
    std::vector<Sphere> claimed_;
    std::vector<MovedPixels> segments_;
    std::vector<std::uint32_t> rest_;
};

Result<void> check_radius(const std::string& field, double radius_m) {
    if (std::isfinite(radius_m) && radius_m > 0.0 && radius_m <= 2.0) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is " + number_text(radius_m),
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
        "is " + number_text(settings.min_radius_m) + ", not below max_radius_m " +
            number_text(settings.max_radius_m),
        "give a range, or radius_m alone"
    );
}

std::unique_ptr<Tracker> make_sphere_tracker(
    const RgbdCamera& camera, TrackedObjects<SphereSettings> objects
) {
    return std::make_unique<SphereTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
