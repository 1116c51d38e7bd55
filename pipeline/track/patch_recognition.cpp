#include "pipeline/track/patch_recognition.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr std::size_t kMatchesAPatch = 200;
constexpr double kMostPatchDistance = 0.5;  // χ²
constexpr std::size_t kFirstLook = 16;      // points after which most poses are given up
constexpr float kFirstScore = 0.15F;
constexpr float kLeastScore = 0.25F;
constexpr std::size_t kSketches = 48;  // poses that are laid upon the picture
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
      sketch_(camera, {240, 60, 2500}),
      fitter_(camera) {}

float PatchRecogniser::score(const Eigen::Isometry3f& T, const std::vector<ViewPoint>& points)
    const {
    const auto fx = static_cast<float>(camera_.depth.fx), fy = static_cast<float>(camera_.depth.fy);
    const auto cx = static_cast<float>(camera_.depth.cx) + 0.5F;
    const auto cy = static_cast<float>(camera_.depth.cy) + 0.5F;
    const float gate = std::clamp(0.15F * static_cast<float>(model_->radius_m), 0.01F, 0.03F);
    int sum = 0;
    std::size_t seen = 0;
    for (const auto& point : points) {
        const Eigen::Vector3f p = T * point.p_obj.cast<float>();
        ++seen;
        if (seen == kFirstLook && static_cast<float>(sum) < kFirstScore * kFirstLook) break;
        if (p.z() < 0.1F) continue;
        const float inverse = 1.0F / p.z();
        const float u = fx * p.x() * inverse + cx, v = fy * p.y() * inverse + cy;
        if (!(u >= 0.0F && v >= 0.0F)) continue;
        const auto column = static_cast<int>(u), row = static_cast<int>(v);
        if (column >= camera_.depth.width || row >= camera_.depth.height) continue;
        const float off = z_[static_cast<std::size_t>(row * camera_.depth.width + column)] - p.z();
        // A reading behind says no, one before says nothing; without a reading z is 0.
        if (std::abs(off) < gate) ++sum;
        if (off > 2.0F * gate) --sum;
    }
    return seen == 0 ? 0.0F : static_cast<float>(sum) / static_cast<float>(seen);
}

void PatchRecogniser::consider(const SurfacePatch& patch, const ModelPatch& match) {
    const Eigen::Matrix3d from = frame_of(match.patch.keypoint);
    Eigen::Matrix3d to = frame_of(patch.keypoint);
    for (int turned = 0; turned < 2; ++turned) {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = to * from.transpose();
        T.translation() = patch.keypoint.p_cam - T.linear() * match.patch.keypoint.p_cam;
        const Eigen::Isometry3f pose = T.cast<float>();
        const float reached = score(pose, table_.view(match.view));
        if (reached >= kLeastScore) proposals_.push_back({pose, reached, match.view});
        to.col(0) = -to.col(0);
        to.col(1) = -to.col(1);
    }
}

void PatchRecogniser::propose(const SurfacePatch& patch) {
    for (const ModelPatch* match : table_.look_up(patch, kMatchesAPatch, kMostPatchDistance))
        consider(patch, *match);
}

std::vector<Eigen::Isometry3d> PatchRecogniser::distinct_best() const {
    std::vector<Eigen::Isometry3d> chosen;
    for (const auto& proposal : proposals_) {
        const Eigen::Isometry3d T = proposal.T_cam_obj.cast<double>();
        const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const auto& other) {
            const double turned = std::acos(
                std::clamp((T.linear() * other.linear().transpose()).trace() / 2.0 - 0.5, -1.0, 1.0)
            );
            return (T.translation() - other.translation()).norm() < 0.15 * model_->radius_m &&
                   turned < 0.2;
        });
        if (is_new) chosen.push_back(T);
        if (chosen.size() == kSketches) break;
    }
    return chosen;
}

double PatchRecogniser::merit(const ModelFit& fit) const {
    const double outline = model_->has_outline ? 0.5 + 0.5 * fit.outline_share : 1.0;
    return fit.seen_share * fit.quality.inlier_share * fit.quality.inlier_share * outline;
}

std::optional<ModelFit> PatchRecogniser::find(std::span<const std::uint16_t> depth) {
    z_.resize(depth.size());
    std::transform(depth.begin(), depth.end(), z_.begin(), [&](std::uint16_t counts) {
        return static_cast<float>(counts * camera_.depth_unit_m);
    });
    proposals_.clear();
    for (const auto& patch : find_surface_patches(depth, camera_, settings_))
        propose(patch);
    std::stable_sort(
        proposals_.begin(),
        proposals_.end(),
        [](const Proposal& a, const Proposal& b) { return a.score > b.score; }
    );

    const ModelFitStart far{0.05, 0.5, 0.06};
    std::vector<ModelFit> sketches;
    for (const auto& T : distinct_best())
        if (auto fit = sketch_.fit(depth, *model_, T, far, kSketchRounds)) sketches.push_back(*fit);
    std::stable_sort(sketches.begin(), sketches.end(), [&](const ModelFit& a, const ModelFit& b) {
        return merit(a) > merit(b);
    });
    if (sketches.size() > kFinals) sketches.resize(kFinals);

    std::optional<ModelFit> best;
    for (const auto& sketch : sketches) {
        const auto fit = fitter_.fit(depth, *model_, sketch.T_cam_obj, {}, 3);
        if (fit && is_accepted(*fit, *model_, camera_, {}) && (!best || merit(*fit) > merit(*best)))
            best = fit;
    }
    return best;
}

}  // namespace kinectlab
