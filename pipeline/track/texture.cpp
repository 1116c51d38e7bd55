#include "pipeline/track/texture.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/track/object_region.hpp"
#include "pipeline/track/picture_box.hpp"
#include "pipeline/track/texture_model.hpp"

namespace kinectlab {
namespace {

constexpr int kLearnMargin_px = 24;        // spots at the object's rim need what surrounds them
constexpr double kSearchMargin_px = 48.0;  // around the last place: some 1.5 m/s at 1 m
constexpr TimeNs kMemory = kNsPerSecond;

std::unique_ptr<SpotFinder> finder_for(const TextureSettings& settings) {
    return settings.spots == TextureSpots::sift ? make_sift_finder() : make_binary_finder();
}

class TextureTracker : public Tracker {
public:
    TextureTracker(const RgbdCamera& camera, TrackedObjects<TextureSettings> objects)
        : camera_(camera),
          cameras_(camera),
          region_(camera),
          row_(static_cast<std::size_t>(camera.depth.width)),
          on_object_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)) {
        for (auto& object : objects) {
            Target target;
            target.scene = finder_for(object.settings);
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
        TrackedObject<TextureSettings> object;
        std::unique_ptr<SpotFinder> scene;
        std::optional<TextureModel> model;
        bool seen = false;
        TimeNs seen_at = 0;
        Eigen::Vector3d place_cam = Eigen::Vector3d::Zero();
    };

    [[nodiscard]] ImageRegion whole() const {
        return {0, 0, camera_.colour.width, camera_.colour.height};
    }
    [[nodiscard]] ImageRegion clipped(double left, double top, double right, double bottom) const {
        const auto within = [](double value, int end) {
            return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(end)));
        };
        return {
            within(left, camera_.colour.width),
            within(top, camera_.colour.height),
            within(right, camera_.colour.width),
            within(bottom, camera_.colour.height)};
    }

    /// What the colour camera shows of some depth pixels, and a margin.
    [[nodiscard]] ImageRegion around(
        const RgbdFrame& frame, std::span<const std::uint32_t> pixels, double margin_px
    ) const {
        double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
        for (const auto pixel : pixels) {
            const auto column = static_cast<int>(pixel) % camera_.depth.width;
            const auto line = static_cast<int>(pixel) / camera_.depth.width;
            const Eigen::Vector2d at = cameras_.colour_pixel(
                camera_.depth.ray(column, line) * (frame.depth[pixel] * camera_.depth_unit_m)
            );
            left = std::min(left, at.x()), right = std::max(right, at.x());
            top = std::min(top, at.y()), bottom = std::max(bottom, at.y());
        }
        return clipped(left - margin_px, top - margin_px, right + margin_px, bottom + margin_px);
    }

    /// Why it has no model yet; empty if it has.
    std::string_view learn(
        Target& target, const RgbdFrame& frame, std::span<const MovedPixels> moved, std::size_t rank
    ) {
        const TextureSettings& settings = target.object.settings;
        if (frame.t - *first_t_ < from_seconds(settings.learn_at_s)) return "it is not learned yet";
        const auto pixels = region_.find(frame, moved, settings.box, rank);
        if (pixels.empty()) return "nothing is there to learn it from";
        std::fill(on_object_.begin(), on_object_.end(), 0);
        for (const auto pixel : pixels)
            on_object_[pixel] = 1;
        auto finder = finder_for(settings);
        finder->find(frame.rgb, camera_.colour.width, around(frame, pixels, kLearnMargin_px));
        auto model = TextureModel::learn(
            camera_, frame, std::move(finder), on_object_, settings.fewest_spots
        );
        if (!model) return "what was to be learned shows too few spots";
        target.place_cam = model->origin_cam();
        target.seen = true;
        target.seen_at = frame.t;
        target.model.emplace(std::move(*model));
        return {};
    }

    [[nodiscard]] ImageRegion near_last_place(const Target& target) const {
        const Eigen::Vector2d middle = cameras_.colour_pixel(target.place_cam);
        const double z = std::max(0.1, target.place_cam.z());
        const double reach = target.model->radius_m() / z * camera_.colour.fx + kSearchMargin_px;
        return clipped(
            middle.x() - reach, middle.y() - reach, middle.x() + reach, middle.y() + reach
        );
    }

    [[nodiscard]] ImageRegion where_it_may_be(
        const RgbdFrame& frame, std::span<const MovedPixels> moved
    ) const {
        if (moved.empty()) return whole();
        ImageRegion all{camera_.colour.width, camera_.colour.height, 0, 0};
        for (const auto& segment : moved) {
            const ImageRegion one = around(frame, segment, kLearnMargin_px);
            all.left = std::min(all.left, one.left), all.right = std::max(all.right, one.right);
            all.top = std::min(all.top, one.top), all.bottom = std::max(all.bottom, one.bottom);
        }
        return all;
    }

    /// Why it is lost; empty if it is tracked.
    std::string_view find(
        Target& target,
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        TrackSample& sample
    ) {
        const auto look = [&](const ImageRegion& region) {
            target.scene->find(frame.rgb, camera_.colour.width, region);
            return target.model->pose_in(frame, *target.scene, target.object.settings.fewest_spots);
        };
        std::optional<TexturePose> pose;
        if (target.seen && frame.t - target.seen_at <= kMemory)
            pose = look(near_last_place(target));
        if (!pose) pose = look(where_it_may_be(frame, moved));
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
        sample.quality.rms_steps = pose->rms_steps;
        return {};
    }

    RgbdCamera camera_;
    TwoCameras cameras_;
    ObjectRegion region_;
    std::optional<TimeNs> first_t_;
    std::vector<std::int32_t> row_;
    std::vector<std::uint8_t> on_object_;
    std::vector<Target> targets_;
};

}  // namespace

Result<void> check(
    const TextureSettings& settings, const RgbdCamera& camera, const std::string& path
) {
    if (settings.box)
        if (auto ok = check_box(*settings.box, camera.colour, path + ".box"); !ok) return ok;
    if (settings.fewest_spots < 4 || settings.fewest_spots > 1000)
        return fail(
            ErrorCode::invalid_argument,
            path + ".fewest_spots",
            "is " + std::to_string(settings.fewest_spots),
            "give a whole number from 4 to 1000"
        );
    return check_learn_at(settings.learn_at_s, path + ".learn_at_s");
}

std::unique_ptr<Tracker> make_texture_tracker(
    const RgbdCamera& camera, TrackedObjects<TextureSettings> objects
) {
    return std::make_unique<TextureTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
