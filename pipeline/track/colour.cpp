#include "pipeline/track/colour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/core/number_text.hpp"
#include "pipeline/features/colour_constancy.hpp"
#include "pipeline/features/two_cameras.hpp"
#include "pipeline/track/colour_bounds.hpp"
#include "pipeline/track/picture_box.hpp"
#include "pipeline/track/surface_pieces.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kFewestPixels = 60;  // fewer are noise
constexpr TimeNs kMemory = kNsPerSecond;   // a place older than this says nothing
constexpr double kShrunkTo = 0.25;         // of the pixels before: perhaps another thing
constexpr double kFastest_m_s = 4.0;       // what moves faster is another thing

class ColourTracker : public Tracker {
public:
    ColourTracker(const RgbdCamera& camera, TrackedObjects<ColourSettings> objects)
        : camera_(camera),
          cameras_(camera),
          pieces_(camera),
          colour_index_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)),
          mask_(colour_index_.size()) {
        for (auto& object : objects) {
            Target target;
            target.object = std::move(object);
            if (target.object.settings.bounds) target.table.emplace(*target.object.settings.bounds);
            targets_.push_back(std::move(target));
        }
    }

    void track(
        const RgbdFrame& frame, std::span<const MovedPixels>, std::vector<TrackSample>& samples
    ) override {
        const bool has_colour =
            frame.rgb.size() ==
            3 * static_cast<std::size_t>(camera_.colour.width * camera_.colour.height);
        if (has_colour) look(frame);
        for (auto& target : targets_) {
            TrackSample sample;
            sample.t = frame.t;
            sample.object = target.object.index;
            if (has_colour) find(target, frame, sample);
            samples.push_back(sample);
        }
    }

    void reset() override {
        constancy_.reset();
        first_t_.reset();
        for (auto& target : targets_) {
            if (!target.object.settings.bounds) target.table.reset();
            target.tried = false;
            target.seen = false;
            target.axes_at_first.reset();
        }
    }

private:
    struct Target {
        TrackedObject<ColourSettings> object;
        std::optional<ColourTable> table;
        bool tried = false;  // to learn the colour
        bool seen = false;
        TimeNs seen_at = 0;
        std::size_t pixels = 0;
        Eigen::Vector3d place_cam = Eigen::Vector3d::Zero();
        std::optional<Eigen::Matrix3d> axes_at_first;
        Eigen::Matrix3d axes_cam = Eigen::Matrix3d::Identity();
    };

    /// What all objects need of a frame: its gains, and the colour pixel of every depth pixel.
    void look(const RgbdFrame& frame) {
        if (!first_t_) first_t_ = frame.t;
        if (!constancy_.has_reference()) constancy_.learn(frame.rgb, camera_.colour.width);
        gains_ = constancy_.gains(frame.rgb);
        entry_ = ColourTable::entry(gains_);
        const int width = camera_.depth.width;
        for (int v = 0; v < camera_.depth.height; ++v) {
            const auto row = static_cast<std::size_t>(v * width);
            cameras_.colour_indices(&frame.depth[row], 0, v, width, &colour_index_[row]);
        }
    }

    void find(Target& target, const RgbdFrame& frame, TrackSample& sample) {
        const ColourSettings& settings = target.object.settings;
        bool in_box_only = false;
        if (!target.table) {
            const bool now = frame.t - *first_t_ >= from_seconds(settings.learn_at_s);
            if (target.tried || !now || !settings.box) return;
            target.tried = true;
            const auto bounds = learn_bounds(
                frame.rgb, camera_.colour.width, camera_.colour.height, *settings.box, gains_
            );
            if (!bounds) return;
            target.table.emplace(*bounds);
            in_box_only = true;
        }
        for (std::size_t i = 0; i < mask_.size(); ++i) {
            const std::int32_t at = colour_index_[i];
            mask_[i] = at >= 0 && target.table->passes(entry_, frame.rgb.data() + 3 * at) ? 1 : 0;
        }
        const auto pieces = pieces_.cut(frame.depth, mask_, kFewestPixels);
        const auto best =
            in_box_only ? most_in_box(pieces, *settings.box) : likely_piece(target, frame, pieces);
        if (best.empty()) return;
        report(target, frame, best, sample);
    }

    MovedPixels most_in_box(std::span<const MovedPixels> pieces, const PictureBox& box) const {
        MovedPixels best;
        std::size_t most = 0;
        for (const auto& piece : pieces) {
            const auto inside = static_cast<std::size_t>(std::count_if(
                piece.begin(),
                piece.end(),
                [&](std::uint32_t pixel) {
                    const int u = colour_index_[pixel] % camera_.colour.width - box.left;
                    const int v = colour_index_[pixel] / camera_.colour.width - box.top;
                    return u >= 0 && v >= 0 && u < box.width && v < box.height;
                }
            ));
            if (inside <= most) continue;
            most = inside;
            best = piece;
        }
        return best;
    }

    /// Biggest where there is no place to hold against; else the nearest that can be the same.
    MovedPixels likely_piece(
        const Target& target, const RgbdFrame& frame, std::span<const MovedPixels> pieces
    ) const {
        if (pieces.empty()) return {};
        const TimeNs age = frame.t - target.seen_at;
        if (!target.seen || age > kMemory) return pieces.front();
        MovedPixels best;
        double nearest = 0.1 + kFastest_m_s * to_seconds(age);
        for (const auto& piece : pieces) {
            if (static_cast<double>(piece.size()) < kShrunkTo * static_cast<double>(target.pixels))
                break;  // sorted, so all others are smaller
            const double off =
                (surface_moments(frame.depth, piece, camera_).centroid_cam - target.place_cam)
                    .norm();
            if (off >= nearest) continue;
            nearest = off;
            best = piece;
        }
        return best;
    }

    void report(Target& target, const RgbdFrame& frame, MovedPixels piece, TrackSample& sample) {
        const SurfaceMoments moments = surface_moments(frame.depth, piece, camera_);
        target.seen = true;
        target.seen_at = frame.t;
        target.pixels = piece.size();
        target.place_cam = moments.centroid_cam;
        sample.status = TrackStatus::tracked;
        sample.p_cam = moments.centroid_cam;
        sample.covariance.topLeftCorner<3, 3>() = moments.centroid_covariance;
        sample.quality.points = static_cast<int>(piece.size());
        sample.quality.inlier_share = 1.0;
        if (!moments.axes_known) return;
        if (!target.axes_at_first) {
            target.axes_at_first = moments.axes_cam;
            target.axes_cam = moments.axes_cam;
        }
        target.axes_cam = nearest_signs(moments.axes_cam, target.axes_cam);
        sample.has_orientation = true;
        sample.q_cam_obj =
            Eigen::Quaterniond(target.axes_cam * target.axes_at_first->transpose()).normalized();
        sample.covariance.bottomRightCorner<3, 3>() = moments.turn_covariance;
    }

    RgbdCamera camera_;
    TwoCameras cameras_;
    SurfacePieces pieces_;
    ColourConstancy constancy_;
    ColourConstancy::Gains gains_{1.0F, 1.0F, 1.0F};
    ColourTable::Entry entry_{};
    std::optional<TimeNs> first_t_;
    std::vector<std::int32_t> colour_index_;
    std::vector<std::uint8_t> mask_;
    std::vector<Target> targets_;
};

Result<void> check_range(
    double low, double high, double most, const std::string& field, bool may_wrap
) {
    const bool fits = low >= 0.0 && high >= 0.0 && low <= most && high <= most;  // not of NaN
    if (fits && (low < high || (may_wrap && low != high))) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is [" + number_text(low) + ", " + number_text(high) + "]",
        std::string("give [lowest, highest] from 0 to ") + (most > 1.0 ? "360" : "1") +
            (may_wrap ? "; lowest > highest goes through red" : "")
    );
}

}  // namespace

Result<void> check(
    const ColourSettings& settings, const RgbdCamera& camera, const std::string& path
) {
    if (settings.bounds.has_value() == settings.box.has_value())
        return fail(
            ErrorCode::invalid_argument,
            path,
            settings.box ? "has both a place to learn the colour from and bounds"
                         : "has neither bounds nor a place to learn the colour from",
            "give hue_deg, or click or box"
        );
    if (auto ok = check_learn_at(settings.learn_at_s, path + ".learn_at_s"); !ok) return ok;
    if (settings.box) return check_box(*settings.box, camera.colour, path + ".box");
    const ColourBounds& b = *settings.bounds;
    if (auto ok = check_range(b.hue_min_deg, b.hue_max_deg, 360.0, path + ".hue_deg", true); !ok)
        return ok;
    if (auto ok = check_range(b.saturation_min, b.saturation_max, 1.0, path + ".saturation", false);
        !ok)
        return ok;
    return check_range(b.value_min, b.value_max, 1.0, path + ".value", false);
}

std::unique_ptr<Tracker> make_colour_tracker(
    const RgbdCamera& camera, TrackedObjects<ColourSettings> objects
) {
    return std::make_unique<ColourTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
