#include "pipeline/track/patch_recognition.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr std::size_t kMatchesAPatch = 200;
constexpr double kMostPatchDistance = 0.5;  // χ²
constexpr float kRoughScore = 0.1F;         // of a pose as it was proposed
constexpr float kLeastScore = 0.3F;         // of one that was moved nearer
constexpr std::size_t kSketches = 160;      // poses that are laid upon the picture
constexpr double kPlainMerit = 0.93;        // with an outline nothing better is to be expected
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
           fit.quality.rms_steps <= limits.most_rms_sigmas * sigma;
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

void PatchRecogniser::consider(const SurfacePatch& patch, const ModelPatch& match) {
    const Eigen::Matrix3d from = frame_of(match.patch.keypoint);
    Eigen::Matrix3d to = frame_of(patch.keypoint);
    for (int turned = 0; turned < 2; ++turned) {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = to * from.transpose();
        T.translation() = patch.keypoint.p_cam - T.linear() * match.patch.keypoint.p_cam;
        const Eigen::Isometry3f pose = T.cast<float>();
        const SketchView& view = table_.view(match.view);
        if (check_.score(pose, view) >= kRoughScore) {
            const Eigen::Isometry3f settled = check_.settle(pose, view);
            const float reached = check_.score(settled, view);
            if (reached >= kLeastScore) proposals_.push_back({settled, reached, match.view});
        }
        to.col(0) = -to.col(0);
        to.col(1) = -to.col(1);
    }
}

void PatchRecogniser::propose(const SurfacePatch& patch) {
    for (const ModelPatch* match : table_.look_up(patch, kMatchesAPatch, kMostPatchDistance))
        consider(patch, *match);
}

std::vector<PatchRecogniser::Proposal> PatchRecogniser::distinct_best() const {
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
        if (chosen.size() == kSketches) break;
    }
    return chosen;
}

/// A cloud has no outline of its own: there the rough check of what lies beside it has to do, or a
/// flat face would fit on any wall.
double PatchRecogniser::merit(const ModelFit& fit, float score) const {
    const double outline =
        0.5 + 0.5 * (model_->has_outline ? fit.outline_share : static_cast<double>(score));
    return fit.seen_share * fit.quality.inlier_share * fit.quality.inlier_share * outline;
}

/// Whether the noise at that distance hides what tells a cloud from any flat thing of its size.
bool PatchRecogniser::is_blurred(double z_m) const {
    const DisparityScale scale(camera_);
    const double sigma_m =
        scale.sigma_at(scale.steps_at(z_m)) * scale.inverse_depth_step * z_m * z_m;
    return sigma_m > kMostNoiseRadii * model_->radius_m;
}

std::optional<ModelFit> PatchRecogniser::find(std::span<const std::uint16_t> depth) {
    check_.set(depth);
    proposals_.clear();
    for (const auto& patch : find_surface_patches(depth, camera_, settings_))
        propose(patch);
    std::stable_sort(
        proposals_.begin(),
        proposals_.end(),
        [](const Proposal& a, const Proposal& b) { return a.score > b.score; }
    );

    struct Sketch {
        Eigen::Isometry3d T_cam_obj;
        float score;
        std::uint32_t view;
        double merit;
    };
    const ModelFitStart far{0.05, 0.5, 0.06};
    std::vector<Sketch> sketches;
    for (const auto& proposal : distinct_best()) {
        const auto fit =
            sketch_.fit(depth, *model_, proposal.T_cam_obj.cast<double>(), far, kSketchRounds);
        if (!fit) continue;
        sketches.push_back(
            {fit->T_cam_obj, proposal.score, proposal.view, merit(*fit, proposal.score)}
        );
        if (model_->has_outline && sketches.back().merit > kPlainMerit) break;
    }
    std::stable_sort(sketches.begin(), sketches.end(), [](const Sketch& a, const Sketch& b) {
        return a.merit > b.merit;
    });
    if (sketches.size() > kFinals) sketches.resize(kFinals);

    std::optional<ModelFit> best;
    double most = 0.0;
    for (const auto& sketch : sketches) {
        const auto fit = fitter_.fit(depth, *model_, sketch.T_cam_obj, {}, 3);
        if (!fit || !is_accepted(*fit, *model_, camera_, {})) continue;
        const float score = check_.score(fit->T_cam_obj.cast<float>(), table_.view(sketch.view));
        const double reached = merit(*fit, score);
        if (!model_->has_outline &&
            (reached < kLeastMeritOfCloud || is_blurred(fit->T_cam_obj.translation().z())))
            continue;
        if (best && reached <= most) continue;
        best = fit;
        most = reached;
    }
    return best;
}

}  // namespace kinectlab
