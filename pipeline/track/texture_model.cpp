#include "pipeline/track/texture_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "pipeline/core/disparity.hpp"

namespace kinectlab {
namespace {

constexpr double kSpot_px = 0.35;      // a spot's place, for the smallest ones
constexpr double kSpotShare = 0.15;    // of its scale, for larger ones
constexpr double kFewestShare = 0.15;  // of the matches must agree
constexpr int kShared_px = 8;          // spots nearer than that share their depth's noise
constexpr float kNear_px = 4.0F;       // around where a spot must be
constexpr float kMostScaleRatio = 1.5F;

/// Of a traced point: aside by the spot's place in the picture, along the ray by the depth.
Eigen::Matrix3d covariance_of(
    const TracedPoint& point, const Keypoint2d& spot, const Pinhole& colour
) {
    const double z = point.p_cam.z();
    const double spot_px = std::max<double>(kSpot_px, kSpotShare * spot.scale_px);
    const double aside = spot_px * z / colour.fx;
    const Eigen::Vector3d ray = point.p_cam / z;
    Eigen::Matrix3d covariance = point.sigma_z_m * point.sigma_z_m * ray * ray.transpose();
    covariance.diagonal().array() += aside * aside;
    return covariance;
}

}  // namespace

std::optional<TextureModel> TextureModel::learn(
    const RgbdCamera& camera,
    const RgbdFrame& frame,
    std::unique_ptr<SpotFinder> found,
    std::span<const std::uint8_t> on_object,
    int fewest
) {
    TextureModel model(camera);
    std::vector<std::uint32_t> kept;
    const auto spots = found->spots();
    for (std::uint32_t i = 0; i < spots.size(); ++i) {
        const auto traced = model.cameras_.trace(frame.depth, spots[i].u, spots[i].v);
        if (!traced || on_object[traced->pixel] == 0) continue;
        kept.push_back(i);
        model.points_.push_back(
            {traced->p_cam,
             covariance_of(*traced, spots[i], camera.colour),
             static_cast<float>(spots[i].scale_px * traced->p_cam.z())}
        );
        model.origin_cam_ += traced->p_cam;
    }
    if (static_cast<int>(kept.size()) < std::max(1, fewest)) return std::nullopt;
    model.origin_cam_ /= static_cast<double>(kept.size());
    for (auto& point : model.points_) {
        point.p_obj -= model.origin_cam_;
        model.radius_m_ = std::max(model.radius_m_, point.p_obj.norm());
    }
    model.spots_ = std::move(found);
    model.spots_->keep(kept);
    return model;
}

void TextureModel::add_pair(const RgbdFrame& frame, const SpotFinder& scene, const Match& match) {
    const Keypoint2d& spot = scene.spots()[match.scene];
    auto& traced = traced_[match.scene];
    if (!traced) traced.emplace(cameras_.trace(frame.depth, spot.u, spot.v));
    if (!*traced) return;
    const TracedPoint& point_cam = **traced;
    const Point& point = points_[match.model];
    pairs_.push_back(
        {point.p_obj,
         point_cam.p_cam,
         point.covariance + covariance_of(point_cam, spot, camera_.colour)}
    );
}

std::optional<RigidFit> TextureModel::fit(
    const RgbdFrame& frame,
    const SpotFinder& scene,
    std::span<const Match> matches,
    const RigidFitSettings& settings
) {
    pairs_.clear();
    for (const auto& match : matches)
        add_pair(frame, scene, match);
    return fit_rigid(pairs_, settings);
}

/// Of the spots in the scene near where one of the model's must be now, the most similar.
void TextureModel::match_near(const SpotFinder& scene, const Eigen::Isometry3d& T_cam_obj) {
    matches_.clear();
    const auto spots = scene.spots();
    taken_.assign(spots.size(), 0);  // place in matches_, from 1
    by_row_.resize(spots.size());
    std::iota(by_row_.begin(), by_row_.end(), 0U);
    std::sort(by_row_.begin(), by_row_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return spots[a].v < spots[b].v;
    });
    for (std::uint32_t m = 0; m < points_.size(); ++m) {
        const Eigen::Vector3d p_cam = T_cam_obj * points_[m].p_obj;
        if (p_cam.z() <= 0.0) continue;
        const Eigen::Vector2f at = cameras_.colour_pixel(p_cam).cast<float>();
        const float scale_px = points_[m].scale_m / static_cast<float>(p_cam.z());
        float best = scene.most_difference();
        std::uint32_t nearest = 0;
        bool found = false;
        const auto first = std::lower_bound(
            by_row_.begin(),
            by_row_.end(),
            at.y() - kNear_px,
            [&](std::uint32_t s, float v) { return spots[s].v < v; }
        );
        for (auto next = first; next != by_row_.end(); ++next) {
            const std::uint32_t s = *next;
            if (spots[s].v > at.y() + kNear_px) break;
            if (std::abs(spots[s].u - at.x()) > kNear_px) continue;
            const float ratio = spots[s].scale_px / scale_px;
            if (ratio > kMostScaleRatio || ratio * kMostScaleRatio < 1.0F) continue;
            const float difference = spots_->difference(m, scene, s);
            if (difference >= best) continue;
            best = difference;
            nearest = s;
            found = true;
        }
        if (!found) continue;
        if (taken_[nearest] == 0) {
            matches_.push_back({m, nearest, best});
            taken_[nearest] = static_cast<std::uint32_t>(matches_.size());
        } else if (best < matches_[taken_[nearest] - 1].distance) {
            matches_[taken_[nearest] - 1] = {m, nearest, best};
        }
    }
}

std::optional<TexturePose> TextureModel::pose_in(
    const RgbdFrame& frame, const SpotFinder& scene, int fewest_inliers
) {
    RigidFitSettings settings;
    settings.fewest_inliers = fewest_inliers;
    settings.fewest_share = kFewestShare;
    traced_.assign(scene.spots().size(), std::nullopt);
    auto first = fit(frame, scene, spots_->match_in(scene), settings);
    if (!first) return std::nullopt;
    TexturePose pose;
    pose.matches = static_cast<int>(pairs_.size());
    first_pairs_.swap(pairs_);
    match_near(scene, first->T_cam_obj);
    if (auto second = fit(frame, scene, matches_, settings);
        second && second->inliers > first->inliers) {
        pose.fit = std::move(*second);
        pose.matches = static_cast<int>(pairs_.size());
    } else {
        pose.fit = *first;
        pairs_.swap(first_pairs_);
    }
    const DisparityScale scale(camera_);
    double squares = 0.0;
    for (const auto i : pose.fit.inlier_pairs) {
        const double expected = (pose.fit.T_cam_obj * pairs_[i].p_obj).z();
        squares += std::pow(scale.steps_at(pairs_[i].p_cam.z()) - scale.steps_at(expected), 2);
    }
    pose.rms_steps = std::sqrt(squares / pose.fit.inliers);
    // Spots that read the same depth pixels err together: as many count as there are such places.
    std::set<std::pair<int, int>> places;
    for (const auto i : pose.fit.inlier_pairs) {
        const Eigen::Vector2d at = camera_.depth.project(pairs_[i].p_cam);
        places.emplace(
            static_cast<int>(at.x()) / kShared_px, static_cast<int>(at.y()) / kShared_px
        );
    }
    pose.fit.covariance *= static_cast<double>(pose.fit.inliers) /
                           static_cast<double>(std::max<std::size_t>(1, places.size()));
    return pose;
}

}  // namespace kinectlab
