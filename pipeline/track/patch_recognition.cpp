#include "pipeline/track/patch_recognition.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinectlab {
namespace {

constexpr std::size_t kMatchesAPatch = 200;
constexpr double kMostPatchDistance = 0.5;  // χ²
constexpr float kRoughScore = 0.1F;         // of a pose as it was proposed
constexpr float kLeastScore = 0.3F;         // of one that was moved nearer
constexpr std::size_t kSketches = 160;      // poses that are laid upon the picture
constexpr std::size_t kMovedSketches = 40;  // of one thing that moved
constexpr std::size_t kMostMoved = 4;       // things that moved, the biggest
constexpr double kWholeThing = 0.85;        // of the object, and of what moved
constexpr double kOutlineOfMoved = 0.45;
constexpr double kOutlineOfPart = 0.85;
constexpr int kBorder_px = 10;        // a Kinect reads nothing in its last columns
constexpr double kPlainMerit = 0.93;  // with an outline nothing better is to be expected
// Cartons of other sizes reach 0.78 with a carton's cloud, itself 0.86.
constexpr double kLeastMeritOfCloud = 0.82;
constexpr double kMostNoiseRadii = 0.03;
constexpr std::size_t kFinals = 4;
constexpr int kSketchRounds = 3;

PatchSettings settings_for(double radius_m) {
    PatchSettings settings;
    settings.fit_radius_m = std::clamp(0.16 * radius_m, 0.012, 0.05);
    settings.patch_radius_m = 2.5 * settings.fit_radius_m;
    return settings;
}

/// Axes: along the direction of least bending, across it, along the normal.
Eigen::Matrix3d frame_of(const CurvedPoint& point) {
    Eigen::Matrix3d axes;
    axes.col(2) = point.normal;
    axes.col(0) = (point.direction - point.normal * point.normal.dot(point.direction)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
}

/// Whether it may go on beyond the picture: its middle then says nothing of the object's.
bool is_cut_off(std::span<const std::uint32_t> pixels, const Pinhole& lens) {
    return std::any_of(pixels.begin(), pixels.end(), [&lens](std::uint32_t pixel) {
        const int column = static_cast<int>(pixel) % lens.width;
        const int row = static_cast<int>(pixel) / lens.width;
        return column < kBorder_px || column >= lens.width - kBorder_px || row < kBorder_px ||
               row >= lens.height - kBorder_px;
    });
}

/// Of the pixels that moved, 1 where that is not known.
double explained_share(const ModelFit& fit, std::size_t moved_pixels) {
    if (moved_pixels == 0) return 1.0;
    const double covered = fit.seen_share * static_cast<double>(fit.pixels);
    return std::min(1.0, covered / static_cast<double>(moved_pixels));
}

/// A thing on a table has no outline where it stands; that it moved as a whole says as much. What
/// moved and is larger may be another thing, or the object and a hand: then the outline has to
/// tell.
Acceptance limits_for(const ModelFit& fit, std::size_t moved_pixels) {
    Acceptance limits;
    if (explained_share(fit, moved_pixels) < kWholeThing) limits.least_outline = kOutlineOfPart;
    const bool is_whole =
        fit.seen_share > kWholeThing && explained_share(fit, moved_pixels) > kWholeThing;
    if (moved_pixels > 0 && is_whole) limits.least_outline = kOutlineOfMoved;
    return limits;
}

}  // namespace

bool is_accepted(
    const ModelFit& fit,
    const ObjectModel& model,
    const RgbdCamera& camera,
    const Acceptance& limits
) {
    const DisparityScale scale(camera);
    const double sigma =
        scale.sigma_at(scale.steps_at(std::max(0.1, fit.T_cam_obj.translation().z())));
    return fit.seen_share >= limits.least_seen &&
           fit.quality.inlier_share >= limits.least_inliers &&
           (!model.has_outline || fit.outline_share >= limits.least_outline) &&
           fit.quality.rms_steps <= limits.most_rms_sigmas * sigma &&
           fit.proof.misfit_share <= limits.most_misfit &&
           fit.proof.goes_on_share <= limits.most_goes_on;
}

PatchRecogniser::PatchRecogniser(
    const RgbdCamera& camera, std::shared_ptr<const ObjectModel> model, std::uint32_t seed
)
    : camera_(camera),
      model_(std::move(model)),
      settings_(settings_for(model_->radius_m)),
      random_(seed),
      table_(camera, *model_, settings_, random_),
      check_(camera, model_->radius_m),
      sketch_(camera, {240, 60, 2500}),
      fitter_(camera) {}

void PatchRecogniser::consider(const ViewPose& pose) {
    const SketchView& view = table_.view(pose.view);
    if (check_.score(pose.T_cam_obj, view) < kRoughScore) return;
    const Eigen::Isometry3f settled = check_.settle(pose.T_cam_obj, view);
    const float reached = check_.score(settled, view);
    if (reached >= kLeastScore) proposals_.push_back({settled, reached, pose.view});
}

void PatchRecogniser::consider(const SurfacePatch& patch, const ModelPatch& match) {
    const Eigen::Matrix3d from = frame_of(match.patch.keypoint);
    Eigen::Matrix3d to = frame_of(patch.keypoint);
    for (int turned = 0; turned < 2; ++turned) {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = to * from.transpose();
        T.translation() = patch.keypoint.p_cam - T.linear() * match.patch.keypoint.p_cam;
        consider({T.cast<float>(), match.view});
        to.col(0) = -to.col(0);
        to.col(1) = -to.col(1);
    }
}

void PatchRecogniser::propose(const SurfacePatch& patch) {
    for (const ModelPatch* match : table_.look_up(patch, kMatchesAPatch, kMostPatchDistance))
        consider(patch, *match);
}

std::vector<PatchRecogniser::Proposal> PatchRecogniser::distinct_best(std::size_t most) const {
    std::vector<Proposal> chosen;
    for (const auto& proposal : proposals_) {
        const Eigen::Isometry3f& T = proposal.T_cam_obj;
        const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const auto& other) {
            const float cosine =
                (T.linear() * other.T_cam_obj.linear().transpose()).trace() / 2.0F - 0.5F;
            return (T.translation() - other.T_cam_obj.translation()).norm() <
                       0.15F * static_cast<float>(model_->radius_m) &&
                   std::acos(std::clamp(cosine, -1.0F, 1.0F)) < 0.2F;
        });
        if (is_new) chosen.push_back(proposal);
        if (chosen.size() == most) break;
    }
    return chosen;
}

/// A cloud has no outline of its own: there the rough check of what lies beside it has to do, or a
/// flat face would fit on any wall. What moved (0 pixels: not known) is the object, not a part of
/// it that looks like another side.
double PatchRecogniser::merit(const ModelFit& fit, float score, std::size_t moved_pixels) const {
    const double outline =
        0.5 + 0.5 * (model_->has_outline ? fit.outline_share : static_cast<double>(score));
    return fit.seen_share * fit.quality.inlier_share * fit.quality.inlier_share * outline *
           explained_share(fit, moved_pixels);
}

/// Whether the noise at that distance hides what tells a cloud from any flat thing of its size.
bool PatchRecogniser::is_blurred(double z_m) const {
    const DisparityScale scale(camera_);
    const double sigma_m =
        scale.sigma_at(scale.steps_at(z_m)) * scale.inverse_depth_step * z_m * z_m;
    return sigma_m > kMostNoiseRadii * model_->radius_m;
}

std::vector<PatchRecogniser::Sketch> PatchRecogniser::best_sketches(
    std::span<const std::uint16_t> depth, std::size_t most, std::size_t moved_pixels
) {
    std::stable_sort(
        proposals_.begin(),
        proposals_.end(),
        [](const Proposal& a, const Proposal& b) { return a.score > b.score; }
    );
    const ModelFitStart far{0.05, 0.5, 0.06};
    std::vector<Sketch> sketches;
    for (const auto& proposal : distinct_best(most)) {
        const auto fit =
            sketch_.fit(depth, *model_, proposal.T_cam_obj.cast<double>(), far, kSketchRounds);
        if (!fit) continue;
        const double reached = merit(*fit, proposal.score, moved_pixels);
        sketches.push_back({fit->T_cam_obj, proposal.score, proposal.view, reached});
        if (model_->has_outline && reached > kPlainMerit) break;
    }
    std::stable_sort(sketches.begin(), sketches.end(), [](const Sketch& a, const Sketch& b) {
        return a.merit > b.merit;
    });
    if (sketches.size() > kFinals) sketches.resize(kFinals);
    return sketches;
}

std::optional<PatchRecogniser::Found> PatchRecogniser::best_fit(
    std::span<const std::uint16_t> depth, std::size_t most, std::size_t moved_pixels
) {
    std::optional<Found> best;
    for (const auto& sketch : best_sketches(depth, most, moved_pixels)) {
        const auto fit = fitter_.fit(depth, *model_, sketch.T_cam_obj, {}, 3);
        if (!fit || !is_accepted(*fit, *model_, camera_, limits_for(*fit, moved_pixels))) continue;
        const float score = check_.score(fit->T_cam_obj.cast<float>(), table_.view(sketch.view));
        const double reached = merit(*fit, score, moved_pixels);
        if (!model_->has_outline &&
            (reached < kLeastMeritOfCloud || is_blurred(fit->T_cam_obj.translation().z())))
            continue;
        if (best && reached <= best->merit) continue;
        best = {*fit, reached, sketch.view};
    }
    return best;
}

std::optional<ModelFit> PatchRecogniser::find_moved(
    std::span<const std::uint16_t> depth, std::span<const std::span<const std::uint32_t>> moved
) {
    check_.set(depth);
    std::optional<Found> best;
    for (const auto& pixels : moved.first(std::min(moved.size(), kMostMoved))) {
        if (is_cut_off(pixels, camera_.depth)) continue;
        proposals_.clear();
        for (const auto& pose : moved_poses(depth, camera_, pixels, table_))
            consider(pose);
        const auto found = best_fit(depth, kMovedSketches, pixels.size());
        if (found && (!best || found->merit > best->merit)) best = found;
    }
    if (!best) return std::nullopt;
    return best->fit;
}

/// Pixels of the segment in which most of what the object shows lies; 0 if it is in none.
std::size_t PatchRecogniser::moved_about(
    const Found& found, std::span<const std::span<const std::uint32_t>> moved
) {
    if (moved.empty()) return 0;
    const std::size_t segments = std::min<std::size_t>(moved.size(), 255);
    moved_.assign(static_cast<std::size_t>(camera_.depth.width * camera_.depth.height), 0);
    for (std::size_t i = 0; i < segments; ++i)
        for (const auto pixel : moved[i])
            moved_[pixel] = static_cast<std::uint8_t>(i + 1);
    std::array<std::size_t, 256> hits{};
    const SketchView& view = table_.view(found.view);
    for (const auto& point : view.surface) {
        const Eigen::Vector2d at =
            camera_.depth.project(found.fit.T_cam_obj * point.p_obj.cast<double>());
        const auto u = std::lround(at.x()), v = std::lround(at.y());
        if (u < 0 || v < 0 || u >= camera_.depth.width || v >= camera_.depth.height) continue;
        ++hits[moved_[static_cast<std::size_t>(v * camera_.depth.width + u)]];
    }
    const auto most = std::max_element(hits.begin() + 1, hits.end());
    if (2 * *most < view.surface.size()) return 0;
    return moved[static_cast<std::size_t>(most - hits.begin() - 1)].size();
}

std::optional<ModelFit> PatchRecogniser::find(
    std::span<const std::uint16_t> depth, std::span<const std::span<const std::uint32_t>> moved
) {
    check_.set(depth);
    proposals_.clear();
    for (const auto& patch : find_surface_patches(depth, camera_, settings_))
        propose(patch);
    const auto found = best_fit(depth, kSketches, 0);
    if (!found) return std::nullopt;
    const std::size_t pixels = moved_about(*found, moved);
    if (!is_accepted(found->fit, *model_, camera_, limits_for(found->fit, pixels)))
        return std::nullopt;
    return found->fit;
}

}  // namespace kinectlab
