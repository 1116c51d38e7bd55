#include "pipeline/track/sift3d.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/object_region.hpp"
#include "pipeline/track/picture_box.hpp"
#include "pipeline/track/sift3d_model.hpp"

namespace kinectlab {
namespace {

constexpr double kNear_m = 0.12;  // around the object's last place: 3.6 m/s at 30 Hz
constexpr TimeNs kMemory = kNsPerSecond;

class Sift3dTracker : public Tracker {
public:
    Sift3dTracker(const RgbdCamera& camera, TrackedObjects<Sift3dTrackSettings> objects)
        : camera_(camera),
          cameras_(camera),
          region_(camera),
          row_(static_cast<std::size_t>(camera.depth.width)),
          mask_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)) {
        for (auto& object : objects) {
            Target target;
            target.object = std::move(object);
            targets_.push_back(std::move(target));
        }
    }

    void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) override {
        const bool has_colour =
            frame.rgb.size() ==
            3 * static_cast<std::size_t>(camera_.colour.width * camera_.colour.height);
        if (!first_t_) first_t_ = frame.t;
        std::size_t rank = 0;  // of what moved, for those without a box
        for (auto& target : targets_) {
            TrackSample sample;
            sample.t = frame.t;
            sample.object = target.object.index;
            std::string_view why_lost = "there is no colour picture";
            if (has_colour && !target.model) why_lost = learn(target, frame, moved, rank);
            if (!target.object.settings.box) ++rank;
            if (has_colour && target.model) why_lost = find(target, frame, moved, sample);
            sample.quality.why_lost = why_lost;
            samples.push_back(sample);
        }
    }

    void reset() override {
        first_t_.reset();
        for (auto& target : targets_) {
            target.model.reset();
            target.seen = false;
        }
    }

private:
    struct Target {
        TrackedObject<Sift3dTrackSettings> object;
        std::optional<Sift3dSpots> model;
        Eigen::Vector3d origin_cam = Eigen::Vector3d::Zero();
        double radius_m = 0.0;
        bool seen = false;
        TimeNs seen_at = 0;
        Eigen::Vector3d place_cam = Eigen::Vector3d::Zero();
    };

    static Sift3dSettings settings_of(const Target& target) {
        Sift3dSettings settings;
        settings.smallest_scale_m = static_cast<float>(target.object.settings.scale_m);
        return settings;
    }

    /// The points with their brightness, in the picture's order; without a mask all of them.
    void gather(const RgbdFrame& frame, bool masked) {
        points_.clear();
        const int width = camera_.depth.width;
        for (int v = 0; v < camera_.depth.height; ++v) {
            const auto first = static_cast<std::size_t>(v * width);
            cameras_.colour_indices(&frame.depth[first], 0, v, width, row_.data());
            for (int u = 0; u < width; ++u) {
                const auto pixel = first + static_cast<std::size_t>(u);
                const std::int32_t at = row_[static_cast<std::size_t>(u)];
                if (at < 0 || (masked && mask_[pixel] == 0)) continue;
                const Eigen::Vector3d p_cam =
                    camera_.depth.ray(u, v) * (frame.depth[pixel] * camera_.depth_unit_m);
                const auto* rgb = frame.rgb.data() + 3 * static_cast<std::ptrdiff_t>(at);
                const float grey = 0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2];
                points_.push_back({p_cam.cast<float>(), grey / 255.0F});
            }
        }
    }

    void mark(std::span<const std::uint32_t> pixels) {
        for (const auto pixel : pixels)
            mask_[pixel] = 1;
    }

    /// Why it has no model yet; empty if it has.
    std::string_view learn(
        Target& target, const RgbdFrame& frame, std::span<const MovedPixels> moved, std::size_t rank
    ) {
        const Sift3dTrackSettings& settings = target.object.settings;
        if (frame.t - *first_t_ < from_seconds(settings.learn_at_s)) return "it is not learned yet";
        const auto pixels = region_.find(frame, moved, settings.box, rank);
        if (pixels.empty()) return "nothing is there to learn it from";
        std::fill(mask_.begin(), mask_.end(), 0);
        mark(pixels);
        gather(frame, true);
        auto spots = find_sift3d(points_, settings_of(target));
        if (static_cast<int>(spots.descriptors.size()) < settings.fewest_spots)
            return "what was to be learned shows too few spots";
        target.origin_cam.setZero();
        for (const auto& spot : spots.keypoints)
            target.origin_cam += spot.p_cam.cast<double>();
        target.origin_cam /= static_cast<double>(spots.keypoints.size());
        target.radius_m = 0.0;
        for (const auto& point : points_)
            target.radius_m =
                std::max(target.radius_m, (point.p_cam.cast<double>() - target.origin_cam).norm());
        target.place_cam = target.origin_cam;
        target.seen = true;
        target.seen_at = frame.t;
        target.model = std::move(spots);
        return {};
    }

    void mark_near(const RgbdFrame& frame, const Eigen::Vector3d& place_cam, double radius_m) {
        const int width = camera_.depth.width;
        for (std::size_t pixel = 0; pixel < mask_.size(); ++pixel) {
            const double z = frame.depth[pixel] * camera_.depth_unit_m;
            if (std::abs(z - place_cam.z()) > radius_m) continue;
            const auto column = static_cast<int>(pixel) % width;
            const auto line = static_cast<int>(pixel) / width;
            const Eigen::Vector3d p_cam = camera_.depth.ray(column, line) * z;
            if ((p_cam - place_cam).squaredNorm() < radius_m * radius_m) mask_[pixel] = 1;
        }
    }

    /// Why it is lost; empty if it is tracked.
    std::string_view find(
        Target& target,
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        TrackSample& sample
    ) {
        const auto look = [&](bool masked) {
            gather(frame, masked);
            return sift3d_pose(
                *target.model,
                target.origin_cam,
                find_sift3d(points_, settings_of(target)),
                target.object.settings.fewest_spots
            );
        };
        std::optional<Sift3dPose> pose;
        if (target.seen && frame.t - target.seen_at <= kMemory) {
            std::fill(mask_.begin(), mask_.end(), 0);
            mark_near(frame, target.place_cam, target.radius_m + kNear_m);
            pose = look(true);
        }
        if (!pose) {
            std::fill(mask_.begin(), mask_.end(), 0);
            for (const auto& segment : moved)
                mark(segment);
            pose = look(!moved.empty());
        }
        if (!pose) return "too few of its spots are seen together";
        target.seen = true;
        target.seen_at = frame.t;
        target.place_cam = pose->fit.T_cam_obj.translation();
        sample.status = TrackStatus::tracked;
        sample.has_orientation = true;
        sample.p_cam = target.place_cam;
        sample.q_cam_obj = Eigen::Quaterniond(pose->fit.T_cam_obj.linear());
        sample.covariance = pose->fit.covariance;
        sample.quality.points = pose->fit.inliers;
        sample.quality.inlier_share =
            static_cast<double>(pose->fit.inliers) / std::max(1, pose->matches);
        return {};
    }

    RgbdCamera camera_;
    TwoCameras cameras_;
    ObjectRegion region_;
    std::optional<TimeNs> first_t_;
    std::vector<std::int32_t> row_;
    std::vector<std::uint8_t> mask_;
    std::vector<ValuedPoint> points_;
    std::vector<Target> targets_;
};

}  // namespace

Result<void> check(
    const Sift3dTrackSettings& settings, const RgbdCamera& camera, const std::string& path
) {
    if (settings.box)
        if (auto ok = check_box(*settings.box, camera.colour, path + ".box"); !ok) return ok;
    if (!(settings.scale_m >= 0.001 && settings.scale_m <= 0.1))
        return fail(
            ErrorCode::invalid_argument,
            path + ".scale_m",
            "is " + number_text(settings.scale_m),
            "give metres from 0.001 to 0.1"
        );
    if (settings.fewest_spots < 4 || settings.fewest_spots > 1000)
        return fail(
            ErrorCode::invalid_argument,
            path + ".fewest_spots",
            "is " + std::to_string(settings.fewest_spots),
            "give a whole number from 4 to 1000"
        );
    return check_learn_at(settings.learn_at_s, path + ".learn_at_s");
}

std::unique_ptr<Tracker> make_sift3d_tracker(
    const RgbdCamera& camera, TrackedObjects<Sift3dTrackSettings> objects
) {
    return std::make_unique<Sift3dTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
