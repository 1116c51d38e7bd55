#include "pipeline/track/shape_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/hough.hpp"
#include "pipeline/track/shape_detect.hpp"
#include "pipeline/track/shapes.hpp"
#include "pipeline/track/sphere.hpp"

namespace kinectlab {
namespace {

constexpr TimeNs kMemory = kNsPerSecond / 2;  // a place older than this says nothing
constexpr std::size_t kMostSegments = 8;      // looked at for one object
constexpr double kSizeTolerance = 0.15;       // of a known size, in a scene

class ShapeTracker : public Tracker {
public:
    ShapeTracker(const RgbdCamera& camera, std::vector<ShapeTarget> targets)
        : camera_(camera), image_(camera), detector_(camera) {
        for (auto& target : targets)
            objects_.push_back({std::move(target), {}, {}, 0, false, {}});
        order_.resize(objects_.size());
        if (std::any_of(objects_.begin(), objects_.end(), is_in_scene))
            scene_.emplace(ShapeDetector::create(camera).value());  // its defaults are sound
    }

    void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) override {
        image_.load(frame.depth);
        shapes_ = scene_ ? scene_->detect(frame.depth) : std::span<const SceneShape>{};
        shape_taken_.assign(shapes_.size(), false);
        segment_taken_.assign(moved.size(), false);
        // Those seen a moment ago choose first, so that a lost one cannot take their shape.
        for (std::size_t i = 0; i < order_.size(); ++i)
            order_[i] = i;
        std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
            const bool fresh_a = is_fresh(objects_[a], frame.t),
                       fresh_b = is_fresh(objects_[b], frame.t);
            return fresh_a != fresh_b ? fresh_a : a < b;
        });
        for (const std::size_t i : order_)
            find(objects_[i], frame, moved);
        for (const auto& object : objects_)
            samples.push_back(object.sample);
    }

    void reset() override {
        for (auto& object : objects_)
            object.has_place = false;
    }

private:
    struct Object {
        ShapeTarget target;
        Eigen::Vector3d place_cam = Eigen::Vector3d::Zero();
        Eigen::Quaterniond q_cam_obj = Eigen::Quaterniond::Identity();
        TimeNs seen_at = 0;
        bool has_place = false;
        TrackSample sample;
    };

    static bool is_in_scene(const Object& object) { return object.target.in == LookIn::scene; }

    static bool is_fresh(const Object& object, TimeNs t) {
        return object.has_place && t - object.seen_at <= kMemory;
    }

    void find(Object& object, const RgbdFrame& frame, std::span<const MovedPixels> moved) {
        object.sample = TrackSample{};
        object.sample.t = frame.t;
        object.sample.object = object.target.index;
        const bool fresh = is_fresh(object, frame.t);
        const auto fit = !is_in_scene(object) ? among_moved(object, fresh, moved)
                         : object.target.search == GuessBy::hough
                             ? detector_.in_scene(image_, object.target)
                             : in_scene(object, fresh);
        if (fit) take(object, *fit, frame.t, fresh);
    }

    /// Nearest to the object's last place first; biggest first where there is none.
    std::optional<ShapeFit> among_moved(
        const Object& object, bool fresh, std::span<const MovedPixels> moved
    ) {
        const std::size_t count = std::min(kMostSegments, moved.size());
        segments_.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            segments_[i] = {i, fresh ? distance(object, moved[i]) : static_cast<double>(i)};
        std::sort(segments_.begin(), segments_.end(), [](const Ranked& a, const Ranked& b) {
            return a.rank < b.rank;
        });
        for (const Ranked& one : segments_) {
            if (segment_taken_[one.index]) continue;
            auto fit = detector_.in_segment(image_, moved[one.index], object.target);
            if (!fit) continue;
            segment_taken_[one.index] = true;
            return fit;
        }
        return std::nullopt;
    }

    double distance(const Object& object, MovedPixels pixels) const {
        double nearest = 1e9;
        const auto width = static_cast<std::uint32_t>(camera_.depth.width);
        const std::size_t step = std::max<std::size_t>(1, pixels.size() / 16);
        for (std::size_t k = 0; k < pixels.size(); k += step) {
            const double s = image_.at(pixels[k]);
            if (s <= 0.0) continue;
            const Eigen::Vector3d p_cam = camera_.depth.ray(pixels[k] % width, pixels[k] / width) /
                                          (s * camera_.noise.inverse_depth_step);
            nearest = std::min(nearest, (p_cam - object.place_cam).norm());
        }
        return nearest;
    }

    std::optional<ShapeFit> in_scene(const Object& object, bool fresh) {
        const SizeLimits& limits = object.target.limits;
        std::size_t best = shapes_.size();
        double best_rank = 0.0;
        for (std::size_t i = 0; i < shapes_.size(); ++i) {
            const Shape& shape = shapes_[i].fit.shape;
            if (shape_taken_[i] || shape.kind != object.target.kind) continue;
            if (shape.kind != ShapeKind::plane) {
                const double off = limits.known ? std::abs(shape.size - *limits.known) : 0.0;
                const bool fits = limits.known
                                      ? off <= kSizeTolerance * *limits.known
                                      : shape.size >= limits.least && shape.size <= limits.most;
                if (!fits) continue;
            }
            const double rank = fresh ? -(shape.point - object.place_cam).norm()
                                      : static_cast<double>(shapes_[i].pixels.size());
            if (best < shapes_.size() && rank <= best_rank) continue;
            best = i;
            best_rank = rank;
        }
        if (best == shapes_.size()) return std::nullopt;
        shape_taken_[best] = true;
        if (!limits.known) return shapes_[best].fit;
        return detector_.with_known_size(image_, shapes_[best], *limits.known);
    }

    void take(Object& object, const ShapeFit& fit, TimeNs t, bool fresh) {
        Eigen::Vector3d z = fit.shape.axis;
        const Eigen::Matrix3d before = object.q_cam_obj.toRotationMatrix();
        if (fit.shape.kind == ShapeKind::cylinder) {
            const double up =
                fresh ? before.col(2).dot(z) : (std::abs(z.y()) > 0.1 ? -z.y() : z.x());
            if (up < 0.0) z = -z;
        }
        TrackSample& sample = object.sample;
        sample.status = TrackStatus::tracked;
        sample.p_cam = fit.shape.point;
        sample.covariance = fit.covariance;
        sample.quality = fit.quality;
        if (fit.size_u > 0.0) {  // else it was known, or the shape has none
            const bool cone = fit.shape.kind == ShapeKind::cone;
            (cone ? sample.size.half_angle_rad : sample.size.radius_m) = fit.shape.size;
            (cone ? sample.size.half_angle_u : sample.size.radius_u) = fit.size_u;
        }
        if (fit.shape.kind != ShapeKind::sphere) {
            Eigen::Vector3d x = fresh ? Eigen::Vector3d(before.col(0)) : Eigen::Vector3d::UnitX();
            if (std::abs(x.dot(z)) > 0.95) x = z.unitOrthogonal();
            Eigen::Matrix3d R_cam_obj;
            R_cam_obj.col(0) = (x - z * z.dot(x)).normalized();
            R_cam_obj.col(1) = z.cross(R_cam_obj.col(0));
            R_cam_obj.col(2) = z;
            sample.q_cam_obj = Eigen::Quaterniond(R_cam_obj);
            sample.has_orientation = true;
        }
        object.place_cam = sample.p_cam;
        object.q_cam_obj = sample.q_cam_obj;
        object.seen_at = t;
        object.has_place = true;
    }

    struct Ranked {
        std::size_t index;
        double rank;
    };

    RgbdCamera camera_;
    DisparityImage image_;
    SegmentShapes detector_;
    std::optional<ShapeDetector> scene_;
    std::vector<Object> objects_;
    std::vector<std::size_t> order_;
    std::span<const SceneShape> shapes_;
    std::vector<bool> shape_taken_, segment_taken_;
    std::vector<Ranked> segments_;
};

SizeLimits limits_of(const auto& settings) {
    return {settings.radius_m, settings.min_radius_m, settings.max_radius_m};
}

struct ToTarget {
    std::optional<ShapeTarget> operator()(const SphereSettings& s) const {
        if (is_for_sphere_tracker(s)) return std::nullopt;
        return ShapeTarget{0, ShapeKind::sphere, limits_of(s), s.in, s.search};
    }
    std::optional<ShapeTarget> operator()(const PlaneSettings& s) const {
        if (!s.under.empty()) return std::nullopt;  // the carrying plane tracker's
        return ShapeTarget{0, ShapeKind::plane, {}, s.in, s.search};
    }
    std::optional<ShapeTarget> operator()(const CylinderSettings& s) const {
        return ShapeTarget{0, ShapeKind::cylinder, limits_of(s), s.in, GuessBy::ransac};
    }
    std::optional<ShapeTarget> operator()(const ConeSettings& s) const {
        return ShapeTarget{
            0,
            ShapeKind::cone,
            {s.half_angle_rad, kLeastConeAngle, kMostConeAngle},
            s.in,
            GuessBy::ransac};
    }
    template <class Other>
    std::optional<ShapeTarget> operator()(const Other&) const {
        return std::nullopt;
    }
};

}  // namespace

std::unique_ptr<Tracker> make_shape_tracker(
    const RgbdCamera& camera, std::vector<ShapeTarget> targets
) {
    return std::make_unique<ShapeTracker>(camera, std::move(targets));
}

std::vector<ShapeTarget> shape_targets(std::span<const ObjectSpec> objects) {
    std::vector<ShapeTarget> targets;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        auto target = std::visit(ToTarget{}, objects[i].settings);
        if (!target) continue;
        target->index = static_cast<std::uint32_t>(i);
        targets.push_back(*target);
    }
    return targets;
}

Result<void> check(const PlaneSettings&, const std::string&) {
    return {};
}

Result<void> check(const CylinderSettings& settings, const std::string& path) {
    // The same rules as for a ball.
    return check(
        SphereSettings{settings.radius_m, settings.min_radius_m, settings.max_radius_m}, path
    );
}

Result<void> check(const ConeSettings& settings, const std::string& path) {
    const double angle = settings.half_angle_rad.value_or(0.5);
    if (std::isfinite(angle) && angle >= kLeastConeAngle && angle <= kMostConeAngle) return {};
    return fail(
        ErrorCode::invalid_argument,
        path + ".half_angle_deg",
        "is " + number_text(angle) + " rad",
        "give 5° to 70° between the axis and the surface"
    );
}

}  // namespace kinectlab
