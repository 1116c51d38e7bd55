#include "pipeline/track/colour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "pipeline/track/colour_bounds.hpp"
#include "pipeline/track/colour_model.hpp"
#include "pipeline/track/colour_sight.hpp"
#include "pipeline/track/first_look.hpp"
#include "pipeline/track/patch_place.hpp"
#include "pipeline/track/picture_box.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kFewestPixels = 60;  // fewer are noise
constexpr TimeNs kMemory = kNsPerSecond;   // a place older than this says nothing
constexpr double kShrunkTo = 0.25;         // of the area before: perhaps another thing
constexpr double kGrownTo = 3.0;
constexpr double kSlack_m = 0.1;
constexpr double kFastest_m_s = 4.0;        // what moves faster is another thing
constexpr double kMostAround = 0.25;        // of the surroundings may have the thing's colours
constexpr double kFewestInBox = 0.1;        // of a box must be the thing
constexpr double kHalfVoteOfBounds = 0.45;  // given bounds: nearly all inside passes, little else
constexpr double kNearest_m = 0.3;          // nearer than any sensor of the family reads

class ColourTracker : public Tracker {
public:
    ColourTracker(const RgbdCamera& camera, TrackedObjects<ColourSettings> objects)
        : camera_(camera),
          sight_(camera),
          first_look_(camera),
          place_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)) {
        for (auto& object : objects) {
            Target target(camera);
            target.object = std::move(object);
            if (target.object.settings.bounds) target.table.emplace(*target.object.settings.bounds);
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
        if (has_colour) {
            if (!first_t_) first_t_ = frame.t;
            sight_.look(frame);
        }
        for (auto& target : targets_) {
            TrackSample sample;
            sample.t = frame.t;
            sample.object = target.object.index;
            sample.quality.why_lost =
                has_colour ? find(target, frame, moved, sample) : "there is no colour picture";
            if (sample.status == TrackStatus::lost) target.patch.lose();
            samples.push_back(sample);
        }
    }

    std::optional<Error> take_fault() override { return std::exchange(fault_, std::nullopt); }

    void reset() override {
        sight_.reset();
        first_t_.reset();
        fault_.reset();
        for (auto& target : targets_) {
            if (!target.object.settings.bounds) target.table.reset();
            target.tried = false;
            target.seen_at.reset();
            target.area_m2 = 0.0;
            target.axes_at_first.reset();
            target.patch.forget();
        }
    }

private:
    struct Target {
        explicit Target(const RgbdCamera& camera) : patch(camera) {}

        TrackedObject<ColourSettings> object;
        std::optional<ColourTable> table;
        double half_vote = 255.0 * kHalfVoteOfBounds;
        bool tried = false;  // to learn the colour
        std::optional<TimeNs> seen_at;
        double area_m2 = 0.0;
        PixelArea area;  // where it was seen, px
        Eigen::Vector3d place_cam = Eigen::Vector3d::Zero();
        std::optional<Eigen::Matrix3d> axes_at_first;
        Eigen::Matrix3d axes_cam = Eigen::Matrix3d::Identity();
        PatchPlace patch;
    };

    /// Why it is lost; empty if it is tracked.
    std::string_view find(
        Target& target,
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        TrackSample& sample
    ) {
        const ColourSettings& settings = target.object.settings;
        if (!target.table) {
            if (target.tried) return "its colour could not be learned";
            if (frame.t - *first_t_ < from_seconds(settings.learn_at_s))
                return "its colour is not learned yet";
            target.tried = true;
            if (auto learned = learn(target, frame, moved); !learned) {
                target.table.reset();
                if (!fault_) fault_ = std::move(learned.error());
                return "its colour could not be learned";
            }
        }
        const bool remembered = target.seen_at && frame.t - *target.seen_at <= kMemory;
        const auto pieces =
            patches(target, remembered ? reach(target, frame.t) : sight_.whole_picture());
        if (pieces.empty()) return "its colour is not seen where it could be";
        const MovedPixels best = likely_piece(target, frame, pieces, remembered);
        if (best.empty())
            return "what has its colour is too far from its last place, or of another size";
        report(target, frame, best, sample);
        return {};
    }

    Result<void> learn(Target& target, const RgbdFrame& frame, std::span<const MovedPixels> moved) {
        const PictureBox& place = *target.object.settings.box;
        const std::string field = "objects[" + std::to_string(target.object.index) + "]." +
                                  (is_click(place) ? "click" : "box");
        if (auto ok =
                first_look_.take(frame, sight_.colour_index(), sight_.gains(), moved, place, field);
            !ok)
            return ok;
        auto model = learn_colours(first_look_.inside(), first_look_.outside());
        if (!model || model->share_outside > kMostAround * model->share_inside)
            return fail(
                ErrorCode::invalid_argument,
                field,
                "shows nothing but colours, or greys, that stand around it too",
                "choose a part with a colour of its own, or the methods texture, sift3d or "
                "surface_patch"
            );
        target.table.emplace(std::move(model->table));
        target.half_vote = 255.0 * 0.5 * (model->share_inside + model->share_outside);

        // Of what has its colours now, the piece that the place shows most of.
        const MovedPixels at_place = first_look_.pixels();
        MovedPixels best = most_of(patches(target, sight_.whole_picture()), at_place);
        if (!best.empty()) {
            const std::size_t passing = sight_.passing(*target.table, best);
            const double share = static_cast<double>(passing) / static_cast<double>(best.size());
            target.half_vote = 255.0 * 0.5 * (share + model->share_outside);
            best = most_of(patches(target, sight_.whole_picture()), at_place);
        }
        const auto seen = static_cast<double>(best.size());
        if (seen < kFewestInBox * static_cast<double>(first_look_.pixels().size()))
            return fail(
                ErrorCode::invalid_argument,
                field,
                "shows no patch of one colour, only " + std::to_string(best.size()) +
                    " depth pixels together",
                "at least " + std::to_string(kFewestPixels) +
                    " are needed: choose a larger patch, or the methods texture or sift3d"
            );
        const auto glance = target.patch.glance(frame, best);
        target.area_m2 = glance.area_m2;
        target.place_cam = glance.centroid_cam;
        target.seen_at = frame.t;
        target.area = sight_.around(best);
        target.patch.expect_wander(wander(target, frame, at_place));
        return {};
    }

    /// How far the place moves if the light lets more or fewer of its pixels pass: pieces of a
    /// print join it or fall off.
    Eigen::Vector3d wander(const Target& target, const RgbdFrame& frame, MovedPixels at_place) {
        Eigen::Vector3d farthest = Eigen::Vector3d::Zero();
        for (const double factor : {1.0 - PatchPlace::kCommonMode, 1.0 + PatchPlace::kCommonMode}) {
            const auto all = sight_.patches(
                *target.table, factor * target.half_vote, sight_.whole_picture(), kFewestPixels
            );
            const MovedPixels piece = most_of(all, at_place);
            if (piece.empty()) continue;
            const Eigen::Vector3d off =
                target.patch.glance(frame, piece).centroid_cam - target.place_cam;
            if (off.norm() > farthest.norm()) farthest = off;
        }
        return farthest;
    }

    std::span<const MovedPixels> patches(const Target& target, const PixelArea& area) {
        return sight_.patches(*target.table, target.half_vote, area, kFewestPixels);
    }

    /// The patch that shares the most pixels with a place.
    [[nodiscard]] MovedPixels most_of(std::span<const MovedPixels> all, MovedPixels place) {
        for (const auto pixel : place)
            place_[pixel] = 1;
        MovedPixels best;
        std::ptrdiff_t most = 0;
        for (const auto& patch : all) {
            const auto shared = std::count_if(patch.begin(), patch.end(), [&](std::uint32_t pixel) {
                return place_[pixel] != 0;
            });
            if (shared <= most) continue;
            most = shared;
            best = patch;
        }
        for (const auto pixel : place)
            place_[pixel] = 0;
        return best;
    }

    static double farthest_m(const Target& target, TimeNs t) {
        return kSlack_m + kFastest_m_s * to_seconds(t - *target.seen_at);
    }

    /// Where in the picture it can be by now.
    [[nodiscard]] PixelArea reach(const Target& target, TimeNs t) const {
        const double off = farthest_m(target, t);
        const double z = std::max(kNearest_m, target.place_cam.z() - off);
        const int wide = static_cast<int>(std::min(1e4, camera_.depth.fx * off / z));
        const int high = static_cast<int>(std::min(1e4, camera_.depth.fy * off / z));
        return {
            std::max(0, target.area.left - wide),
            std::max(0, target.area.top - high),
            std::min(camera_.depth.width, target.area.right + wide),
            std::min(camera_.depth.height, target.area.bottom + high)};
    }

    /// Where there is a place to hold against, the nearest that can be the same. Else the one
    /// nearest in size; else the biggest.
    [[nodiscard]] MovedPixels likely_piece(
        const Target& target,
        const RgbdFrame& frame,
        std::span<const MovedPixels> pieces,
        bool remembered
    ) const {
        if (target.area_m2 <= 0.0) return pieces.front();
        MovedPixels best;
        double least = std::numeric_limits<double>::max();
        for (const auto& piece : pieces) {
            const auto glance = target.patch.glance(frame, piece);
            const double size = glance.area_m2 / target.area_m2;
            if (size < kShrunkTo || size > kGrownTo) continue;
            const double off = remembered ? (glance.centroid_cam - target.place_cam).norm()
                                          : std::abs(std::log(size));
            if (off >= least || (remembered && off >= farthest_m(target, frame.t))) continue;
            least = off;
            best = piece;
        }
        return best;
    }

    void report(Target& target, const RgbdFrame& frame, MovedPixels front, TrackSample& sample) {
        const double front_m2 = target.patch.glance(frame, front).area_m2;
        const MovedPixels piece = sight_.with_sides(front, target.half_vote, front_m2);
        const auto place = target.patch.measure(frame, piece, sight_.votes(), target.half_vote);
        target.seen_at = frame.t;
        target.area_m2 = target.patch.glance(frame, piece).area_m2;
        target.area = sight_.around(piece);
        target.place_cam = place.centroid_cam;
        sample.status = TrackStatus::tracked;
        sample.p_cam = place.centroid_cam;
        sample.covariance.topLeftCorner<3, 3>() = place.covariance;
        sample.quality.points = place.points;
        sample.quality.inlier_share =
            static_cast<double>(place.points) / static_cast<double>(piece.size());
        if (!place.axes_known) return;
        if (!target.axes_at_first) {
            target.axes_at_first = place.axes_cam;
            target.axes_cam = place.axes_cam;
        }
        target.axes_cam = nearest_signs(place.axes_cam, target.axes_cam);
        sample.has_orientation = true;
        sample.q_cam_obj =
            Eigen::Quaterniond(target.axes_cam * target.axes_at_first->transpose()).normalized();
        sample.covariance.bottomRightCorner<3, 3>() = place.turn_covariance;
    }

    RgbdCamera camera_;
    ColourSight sight_;
    FirstLook first_look_;
    std::optional<TimeNs> first_t_;
    std::optional<Error> fault_;
    std::vector<std::uint8_t> place_;  // a byte a depth pixel, all 0 between calls
    std::vector<Target> targets_;
};

}  // namespace

std::unique_ptr<Tracker> make_colour_tracker(
    const RgbdCamera& camera, TrackedObjects<ColourSettings> objects
) {
    return std::make_unique<ColourTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
