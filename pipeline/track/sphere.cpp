#include "pipeline/track/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "pipeline/track/assignment.hpp"
#include "pipeline/track/radius_check.hpp"
#include "pipeline/track/shape_memory.hpp"
#include "pipeline/track/sphere_detect.hpp"

namespace kinectlab {
namespace {

constexpr std::string_view kNothingMoved = "nothing moved";
constexpr std::string_view kNoSphere =
    "nothing that moved is a sphere of its size, whole and alone";
constexpr std::string_view kOtherRadius =
    "the sphere there has another radius than radius_m: measure it, or leave radius_m out and give "
    "min_radius_m and max_radius_m";

constexpr TimeNs kMemory = kNsPerSecond / 2;  // a place older than this is no place to look first
constexpr std::size_t kMostTries = 8;         // segments looked at for one object
constexpr std::size_t kMostPassedBy = 2;      // other balls that touch it

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
        : detector_(camera), assignment_(objects.size(), objects.size()) {
        for (auto& object : objects)
            targets_.push_back({std::move(object), {}, {}, false, {}});
        order_.resize(targets_.size());
        for (auto* list : {&alike_, &order_})
            list->reserve(targets_.size());
        segments_.reserve(std::max(kMostTries, 2 * targets_.size()));
        claimed_.reserve(targets_.size());
        passed_by_.reserve(kMostPassedBy);
        fits_.reserve(targets_.size());
        cost_.reserve(targets_.size() * targets_.size());
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
            target.memory.forget();
    }

private:
    struct Target {
        TrackedObject<SphereSettings> object;
        ShapeMemory memory;
        RadiusCheck radius_check;
        bool done = false;  // in this frame
        TrackSample sample;
    };

    static bool is_fresh(const Target& target, TimeNs t, TimeNs memory = kMemory) {
        return target.memory.is_fresh(t, memory);
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
        why_lost_ = moved.empty() ? kNothingMoved : kNoSphere;
        for (const auto& pixels : likely_segments(frame, moved)) {
            // Balls that touch are one segment.
            passed_by_.clear();
            while (fits_.size() < alike_.size() && passed_by_.size() < kMostPassedBy) {
                auto fit = detector_.find(frame, pixels, settings, {claimed_, passed_by_});
                if (!fit) break;
                if (!may_be_one(*fit, frame.t) ||
                    (settings.radius_m && has_other_radius(*fit, frame))) {
                    passed_by_.push_back(fit->sphere);
                    continue;
                }
                claimed_.push_back(fit->sphere);
                fits_.push_back(std::move(*fit));
            }
            if (fits_.size() == alike_.size()) break;
        }
        passed_by_.clear();
        for (const std::size_t i : alike_)
            targets_[i].sample.quality.why_lost = why_lost_;
        name_fits(frame.t);
    }

    static ShapeSighting sighting_of(const SphereFit& fit, TimeNs t) {
        const double variance = kLeastSpread * kLeastSpread + fit.covariance.trace() / 3.0;
        const bool is_free = fit.radius_u > 0.0;
        return {
            t, fit.sphere.centre_cam, variance, is_free ? fit.sphere.radius : 0.0, fit.radius_u};
    }

    /// Whether a ball may be one of the objects alike; which of several is for name_fits to say.
    [[nodiscard]] bool may_be_one(const SphereFit& fit, TimeNs t) const {
        const ShapeSighting seen = sighting_of(fit, t);
        if (alike_.size() == 1) return targets_[alike_.front()].memory.may_be(seen);
        return std::any_of(alike_.begin(), alike_.end(), [&](std::size_t i) {
            return targets_[i].memory.is_alike(seen);
        });
    }

    /// Gives each ball to the object that was most likely to be there.
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
        if (!target.memory.is_alike(sighting_of(fit, t))) return kNoBall;
        if (!is_fresh(target, t, kNameMemory)) return kAnywhere;
        const PredictedPoint& place = target.memory.place();
        const double surprise = kSurpriseRadii * fit.sphere.radius;
        const double variance =
            std::min(place.variance_at(t) + surprise * surprise, kMostSpread * kMostSpread);
        const double far = (fit.sphere.centre_cam - place.at(t)).squaredNorm() / variance;
        if (far > kGate) return kNoBall;
        return far + 3.0 * std::log(1.0 + variance / (kUnitSpread * kUnitSpread));
    }

    void take(Target& target, const SphereFit& fit, TimeNs t) const {
        target.memory.observe(
            sighting_of(fit, t), alike_.size() == 1 ? ShapeMemory::kDuration : kNameMemory
        );
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
            const Eigen::Vector3d expected = targets_[i].memory.place().at(frame.t);
            for (std::size_t k = 0; k < pixels.size(); k += step)
                nearest = std::min(nearest, (detector_.point(frame, pixels[k]) - expected).norm());
        }
        return nearest;
    }

    /// Whether what was seen of a ball shows that the known radius is not its own.
    bool has_other_radius(const SphereFit& known, const RgbdFrame& frame) {
        const std::size_t index =
            *std::min_element(alike_.begin(), alike_.end(), [&](std::size_t a, std::size_t b) {
                const RadiusCheck &one = targets_[a].radius_check,
                                  &other = targets_[b].radius_check;
                const bool is_one = one.is_of(known.sphere, frame.t);
                if (is_one != other.is_of(known.sphere, frame.t)) return is_one;
                return one.last_seen() < other.last_seen();
            });
        RadiusCheck& check = targets_[index].radius_check;
        if (check.follow(known.sphere, frame.t))
            if (const auto free = detector_.with_free_radius(frame, known.sphere))
                check.add(free->sphere.radius, free->radius_u);
        if (!check.is_other(known.sphere)) return false;
        why_lost_ = kOtherRadius;
        return true;
    }

    SphereDetector detector_;
    std::vector<Target> targets_;
    std::vector<std::size_t> order_, alike_;
    std::vector<SphereFit> fits_;  // of the objects alike
    std::vector<double> cost_;
    Assignment assignment_;
    std::string_view why_lost_;  // of the objects alike
    std::vector<Sphere> claimed_;
    std::vector<Sphere> passed_by_;  // of a segment: balls that are none of the objects alike
    std::vector<MovedPixels> segments_;
};

}  // namespace

std::unique_ptr<Tracker> make_sphere_tracker(
    const RgbdCamera& camera, TrackedObjects<SphereSettings> objects
) {
    return std::make_unique<SphereTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
