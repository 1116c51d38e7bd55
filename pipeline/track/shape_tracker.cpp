#include "pipeline/track/shape_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/track/plane_wander.hpp"
#include "pipeline/track/shape_detect.hpp"
#include "pipeline/track/shape_memory.hpp"
#include "pipeline/track/shapes.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kMostSegments = 8;  // looked at for one object
constexpr double kSizeTolerance = 0.15;   // of a known size, in a scene

ShapeSighting sighting_of(const ShapeFit& fit, TimeNs t) {
    const double variance = fit.covariance.topLeftCorner<3, 3>().trace() / 3.0;
    return {t, fit.shape.point, variance, fit.size_u > 0.0 ? fit.shape.size : 0.0, fit.size_u};
}

class ShapeTracker : public Tracker {
public:
    ShapeTracker(const RgbdCamera& camera, std::vector<ShapeTarget> targets)
        : camera_(camera), image_(camera), detector_(camera) {
        for (auto& target : targets)
            objects_.push_back({std::move(target), {}, {}, Eigen::Quaterniond::Identity(), {}});
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
        voted_.clear();
        // Those seen a moment ago choose first, so that a lost one cannot take their shape.
        for (std::size_t i = 0; i < order_.size(); ++i)
            order_[i] = i;
        std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
            const bool fresh_a = objects_[a].memory.is_fresh(frame.t),
                       fresh_b = objects_[b].memory.is_fresh(frame.t);
            return fresh_a != fresh_b ? fresh_a : a < b;
        });
        for (const std::size_t i : order_)
            find(objects_[i], frame, moved);
        for (const auto& object : objects_)
            samples.push_back(object.sample);
    }

    void reset() override {
        for (auto& object : objects_) {
            object.memory.forget();
            object.wander = {};
        }
    }

private:
    struct Object {
        ShapeTarget target;
        ShapeMemory memory;
        PlaneWander wander;
        Eigen::Quaterniond q_cam_obj = Eigen::Quaterniond::Identity();
        TrackSample sample;
    };

    static bool is_in_scene(const Object& object) { return object.target.in == LookIn::scene; }

    void find(Object& object, const RgbdFrame& frame, std::span<const MovedPixels> moved) {
        object.sample = TrackSample{};
        object.sample.t = frame.t;
        object.sample.object = object.target.index;
        const auto fit = !is_in_scene(object) ? among_moved(object, frame.t, moved)
                         : object.target.search == GuessBy::hough ? by_votes(object, frame.t)
                                                                  : in_scene(object, frame.t);
        if (fit) take(object, *fit, frame.t);
    }

    /// Nearest to the object's last place first; biggest first where there is none.
    std::optional<ShapeFit> among_moved(
        const Object& object, TimeNs t, std::span<const MovedPixels> moved
    ) {
        const bool fresh = object.memory.is_fresh(t);
        const std::size_t count = std::min(kMostSegments, moved.size());
        segments_.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            segments_[i] = {i, fresh ? distance(object, t, moved[i]) : static_cast<double>(i)};
        std::sort(segments_.begin(), segments_.end(), [](const Ranked& a, const Ranked& b) {
            return a.rank < b.rank;
        });
        for (const Ranked& one : segments_) {
            if (segment_taken_[one.index]) continue;
            auto fit = detector_.in_segment(image_, moved[one.index], object.target);
            if (!fit || !object.memory.may_be(sighting_of(*fit, t))) continue;
            segment_taken_[one.index] = true;
            return fit;
        }
        return std::nullopt;
    }

    double distance(const Object& object, TimeNs t, MovedPixels pixels) const {
        double nearest = 1e9;
        const auto width = static_cast<std::uint32_t>(camera_.depth.width);
        const std::size_t step = std::max<std::size_t>(1, pixels.size() / 16);
        for (std::size_t k = 0; k < pixels.size(); k += step) {
            const double s = image_.at(pixels[k]);
            if (s <= 0.0) continue;
            const Eigen::Vector3d p_cam = camera_.depth.ray(pixels[k] % width, pixels[k] / width) /
                                          (s * camera_.noise.inverse_depth_step);
            nearest = std::min(nearest, object.memory.distance(t, p_cam));
        }
        return nearest;
    }

    /// What another object found by votes in this frame is not voted for again.
    std::optional<ShapeFit> by_votes(const Object& object, TimeNs t) {
        taken_.clear();
        for (const Shape& shape : voted_)
            if (shape.kind == object.target.kind) taken_.push_back(shape);
        const bool fresh = object.memory.is_fresh(t);
        auto fit = detector_.in_scene(image_, object.target, taken_, [&](const ShapeFit& one) {
            const ShapeSighting seen = sighting_of(one, t);
            if (!object.memory.may_be(seen)) return 0.0;
            return fresh ? 1.0 / (1.0 + object.memory.distance(t, seen.p_cam))
                         : static_cast<double>(one.quality.points);
        });
        if (fit) voted_.push_back(fit->shape);
        return fit;
    }

    std::optional<ShapeFit> in_scene(const Object& object, TimeNs t) {
        const bool fresh = object.memory.is_fresh(t);
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
            if (!object.memory.may_be(sighting_of(shapes_[i].fit, t))) continue;
            const double rank = fresh ? -object.memory.distance(t, shape.point)
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

    void take(Object& object, const ShapeFit& fit, TimeNs t) {
        const bool fresh = object.memory.is_fresh(t);
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
        if (fit.shape.kind == ShapeKind::plane && is_in_scene(object))
            sample.covariance.topLeftCorner<3, 3>() += wander_of(object, fit, t);
        if (fit.size_u > 0.0) {  // else it was known, or the shape has none
            const bool cone = fit.shape.kind == ShapeKind::cone;
            (cone ? sample.size.half_angle_rad : sample.size.radius_m) = fit.shape.size;
            (cone ? sample.size.half_angle_u : sample.size.radius_u) = fit.size_u;
        }
        if (fit.shape.kind != ShapeKind::sphere) {
            const Eigen::Vector3d x =
                fresh ? Eigen::Vector3d(before.col(0)) : Eigen::Vector3d::UnitX();
            sample.q_cam_obj = attitude_about(z, x);
            sample.has_orientation = true;
        }
        object.q_cam_obj = sample.q_cam_obj;
        object.memory.observe(sighting_of(fit, t));
    }

    Eigen::Matrix3d wander_of(Object& object, const ShapeFit& fit, TimeNs t) const {
        const Eigen::Vector3d& middle = fit.shape.point;
        const Eigen::Vector3d& normal = fit.shape.axis;
        const double slant = std::max(0.1, std::abs(normal.dot(middle.normalized())));
        const double area = fit.quality.points * middle.z() * middle.z() /
                            (camera_.depth.fx * camera_.depth.fy * slant);
        return object.wander.variance(t, middle, normal, area) *
               (Eigen::Matrix3d::Identity() - normal * normal.transpose());
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
    std::vector<Shape> voted_, taken_;  // by votes in this frame
};

}  // namespace

std::unique_ptr<Tracker> make_shape_tracker(
    const RgbdCamera& camera, std::vector<ShapeTarget> targets
) {
    return std::make_unique<ShapeTracker>(camera, std::move(targets));
}

}  // namespace kinectlab
